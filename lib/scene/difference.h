// Whether two scenes are the same simulation.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline scene_module {

/// The keys in which two scenes differ, and how: "solver.iterations: 4 before, 8 now; viscosity:
/// off before, on now", the first of many (first_of()); empty when there is none.
/// Keys that leave the results of a run alone up to its end (Effect, keys.h) are not looked at.
std::string physics_difference(const Scene& before, const Scene& now);

/// "a; b; c", of more than `most` "a; b; ...; and 12 more": a list in a message that stays
/// readable.
std::string first_of(std::vector<std::string> parts, std::size_t most = 8);

}  // namespace pbf::inline scene_module
