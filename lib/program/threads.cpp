#include "lib/program/threads.h"

#include <algorithm>
#include <cstdlib>

#include "lib/base/machine.h"
#include "lib/base/text.h"

namespace pbf::inline program_module {
namespace {

// Measured (lib/solver/README.md): on idle cores two threads pay from 2000 particles on; beside
// another busy process they cost where an update is short. 1024 particles share one piece of the
// lists' making, so more threads than pieces find no work there.
constexpr std::int64_t kOneThreadBelow = 4096, kParticlesPerThread = 1024;

// A waiting thread looks for work a little while (some 50 us, about what waking it would take),
// then sleeps. By default GCC's OpenMP runtime looks a hundred times longer: on a machine whose
// cores are shared the waiting threads then keep the cores from those with work. The runtime reads
// its environment in a constructor of its own. It is linked statically (.cmake/dependencies.cmake),
// so that this one, of the first priority a program may have, runs before; clang's runtime reads it
// when the first loop begins. Whoever sets either variable has their way.
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
  std::string out = format("%d thread%s", threads, threads == 1 ? "" : "s");
  if (scene.threads > 0 || threads == usable) return out;
  if (particles < kOneThreadBelow)
    return out + format(" (of %d: fewer than %d particles)", usable, int(kOneThreadBelow));
  return out + format(" (of %d: one for every %d particles)", usable, int(kParticlesPerThread));
}

}  // namespace pbf::inline program_module
