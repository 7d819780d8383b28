#include <fmt/core.h>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/exec/cpu/cpu_solver.h"
#ifdef PBF_HAS_CUDA
#include "lib/exec/cuda/cuda_solver.h"
#endif
#include "lib/exec/make_solver.h"
#include "lib/exec/ranks/world.h"
#include "lib/program/plan.h"
#include "lib/program/rank_plan.h"
#include "lib/solver/solver.h"

namespace pbf::exec_module {

void refuse_if_too_large(const Scene& scene, const Plan& plan, std::size_t available) {
  // Of several ranks this is the one with most; where the others are is not known.
  const auto needed = double(world() ? plan_ranks(plan, scene, world()->size()).first_bytes
                                     : plan.memory.host_peak());
  if (available > 0 && needed > double(available))
    throw Error(ExitCode::unavailable,
                fmt::format("scene {} needs about {} of memory for {} particles, {} are available; "
                            "{}, or use a machine with more memory",
                            scene.name, bytes_text(needed), plan.particles,
                            bytes_text(double(available)), memory_remedy(scene, plan)));
}

std::unique_ptr<Solver> make_solver(const Scene& scene, const Plan& plan, Particles particles,
                                    Communicator* ranks) {
  if (scene.backend == Backend::cpu)
    return make_cpu_solver(scene, plan, std::move(particles), ranks);
#ifdef PBF_HAS_CUDA
  return make_cuda_solver(scene, plan, std::move(particles), 0, ranks);
#else
  throw Error(ExitCode::unavailable,
              "this build has no CUDA backend; run with --backend cpu, or build with "
              "tools/demo --cuda (-DPBF_CUDA=ON) where a CUDA toolkit is installed");
#endif
}

}  // namespace pbf::exec_module
