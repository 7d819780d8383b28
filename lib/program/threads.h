// The number of threads of a CPU solver. The source file sets, before main(), how threads wait.
#pragma once

#include <cstdint>
#include <string>

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// Threads of a CPU solver of so many particles: what the scene gives; where it leaves that open,
/// one below 4096 particles, else one for every 1024, at most usable_threads() of this machine.
int solver_threads(const Scene& scene, std::int64_t particles);

/// "1 thread (of 2: fewer than 4096 particles)": the number and why it is that.
std::string threads_text(const Scene& scene, std::int64_t particles);

}  // namespace pbf::inline program_module
