// The number of threads of a CPU solver. Before main(), the source file also sets how threads wait.
#pragma once

#include <cstdint>
#include <string>

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// Threads of a CPU solver: the number in the scene. If the scene does not set it, 1 below 4096
/// particles, otherwise one for every 1024 particles, at most usable_threads() of this machine.
int solver_threads(const Scene& scene, std::int64_t particles);

/// "1 thread (of 2: fewer than 4096 particles)": the number and its reason.
std::string threads_text(const Scene& scene, std::int64_t particles);

}  // namespace pbf::program_module
