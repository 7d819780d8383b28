#include "lib/program/threads.h"

#include <fmt/core.h>
#include <algorithm>
#include <cstdlib>

#include "lib/base/machine.h"

namespace pbf::program_module {
namespace {

// lib/solver/README.md has the measurements behind kOneThreadBelow. Lists are made in pieces of
// 1024 particles, so more threads than pieces would be idle.
constexpr std::int64_t kOneThreadBelow = 4096, kParticlesPerThread = 1024;

// A waiting thread checks for work for about 50 us, the time that waking it would take, then
// sleeps. By default, threads of GCC's OpenMP runtime check for longer and occupy cores that others
// could use (lib/solver/README.md). The runtime reads its environment in a constructor. It is
// linked statically (.cmake/dependencies.cmake), so that this constructor, which has the first
// priority open to programs, runs earlier. clang's runtime reads the environment at the first loop.
// Variables that the user has set are not changed.
[[gnu::constructor(101)]] void wait_without_spinning() {
  if (std::getenv("OMP_WAIT_POLICY")) return;
  setenv("GOMP_SPINCOUNT", "1000", 0);
  setenv("OMP_WAIT_POLICY", "passive", 0);
}

}  // namespace

int solver_threads(const Scene& scene, std::int64_t particles) {
  if (scene.threads > 0) return scene.threads;
  if (particles < kOneThreadBelow) return 1;
  return int(std::min<std::int64_t>(usable_threads(), particles / kParticlesPerThread));
}

std::string threads_text(const Scene& scene, std::int64_t particles) {
  const int threads = solver_threads(scene, particles), usable = usable_threads();
  std::string out = fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
  if (scene.threads > 0 || threads == usable) return out;
  if (particles < kOneThreadBelow)
    return out + fmt::format(" (of {}: fewer than {} particles)", usable, int(kOneThreadBelow));
  return out +
         fmt::format(" (of {}: one for every {} particles)", usable, int(kParticlesPerThread));
}

}  // namespace pbf::program_module
