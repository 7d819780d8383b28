#include "lib/exec/cpu/cpu_solver.h"

#include <new>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/start_thread.h"
#include "lib/exec/cpu/cpu_exec.h"
#include "lib/program/threads.h"
#include "lib/solver/step_solver.h"

namespace pbf::PBF_VARIANT {

std::unique_ptr<Solver> make_cpu_solver(const Scene& scene, const Plan& plan,
                                        Particles particles) try {
  const int threads = solver_threads(scene, plan.particles), entries = cpu_list_entries(scene);
  require_threads(threads);
  if (scene.precision == Precision::dbl)
    return std::make_unique<StepSolver<double, CpuExec>>(scene, plan, std::move(particles), threads,
                                                         entries);
  return std::make_unique<StepSolver<float, CpuExec>>(scene, plan, std::move(particles), threads,
                                                      entries);
} catch (const std::bad_alloc&) {
  throw Error(ExitCode::unavailable, "not enough memory for " + std::to_string(plan.particles) +
                                         " particles; increase fluid.spacing, or use a machine "
                                         "with more memory (pbf plan says how much)");
}

}  // namespace pbf::PBF_VARIANT
