// Whether two scenes are the same simulation.
#pragma once

#include <string>

#include "lib/scene/scene.h"

namespace pbf::inline scene_module {

/// The first key in which two scenes differ, and how: "solver.iterations: 4 before, 8 now"; empty
/// when there is none. Keys that leave the results of a run alone up to its end (Effect, keys.h)
/// are not looked at.
std::string physics_difference(const Scene& before, const Scene& now);

}  // namespace pbf::inline scene_module
