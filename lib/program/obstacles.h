// The obstacles of a scene in the form that the kernels use.
#pragma once

#include <functional>
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
/// From the scene's axes to the internal ones.
void turn_to_internal(const Axes& axes, std::vector<Solid<double>>& solids);

/// The part of a map that is made, 0 to 1; called at times by one thread.
using MapProgress = std::function<void(double done)>;
/// The same of an obstacle, by its number.
using ObstacleProgress = std::function<void(std::size_t obstacle, double done)>;
/// Makes the maps of obstacles whose surfaces come from files (kernels/shapes/mesh.h), which may
/// take long. solids_of() makes those that there are not yet. Throws Error(bad_input), naming
/// obstacle and file, for a map that is too large.
void make_maps(const Scene& scene, const ObstacleProgress& progress = {});

/// m: at the start, particles in an obstacle or nearer to it than this are omitted.
inline double least_distance(const Scene& scene) { return 0.4 * scene.fluid.spacing; }

}  // namespace pbf::program_module
