// The obstacles of a scene in the form that the kernels use.
#pragma once

#include <vector>

#include "kernels/boundary/obstacle.h"
#include "lib/program/axes.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// Lengths in h from Scene::origin(), along the internal axes. A face of a box or a cylinder's end
/// that lies on a wall of the domain or behind it is none: the solid goes on there. time: s since
/// the start.
std::vector<Solid<double>> solids_of(const Scene& scene, const Axes& axes, double time = 0);
/// The same along the scene's axes.
std::vector<Solid<double>> solids_of(const Scene& scene, double time = 0);

/// m: particles of a start that are nearer to an obstacle, or in it, are left out.
inline double least_distance(const Scene& scene) { return 0.4 * scene.fluid.spacing; }

}  // namespace pbf::inline program_module
