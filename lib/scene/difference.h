// Whether two scenes are the same simulation.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// The keys in which two scenes differ, and how: "solver.iterations: 4 before, 8 now; viscosity:
/// off before, on now", shortened by first_of(); empty if there is no difference. Keys that do not
/// change the results of a run up to its end (Effect, keys.h) are ignored.
std::string physics_difference(const Scene& before, const Scene& now);

/// "a; b; c", or with more than `most` parts "a; b; ...; and 12 more", to keep messages short.
std::string first_of(std::vector<std::string> parts, std::size_t most = 8);

}  // namespace pbf::scene_module
