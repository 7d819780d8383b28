// The obstacles of a scene in the form that the kernels use.
#pragma once

#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/program/axes.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

/// Lengths in h from Scene::origin(), along the internal axes. A face of a box or an end of a
/// cylinder that lies on or behind a wall of the domain is ignored: the solid continues there.
/// time: s since the start.
std::vector<Solid<double>> solids_of(const Scene& scene, const Axes& axes, double time = 0);
/// The same along the scene's axes.
std::vector<Solid<double>> solids_of(const Scene& scene, double time = 0);

/// m: at the start, particles in an obstacle or nearer to it than this are omitted.
inline double least_distance(const Scene& scene) { return 0.4 * scene.fluid.spacing; }

}  // namespace pbf::program_module
