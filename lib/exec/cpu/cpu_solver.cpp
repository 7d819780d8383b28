#include "lib/exec/cpu/cpu_solver.h"

#include <new>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/start_thread.h"
#include "lib/exec/cpu/cpu_exec.h"
#include "lib/exec/periodic/periodic_exec.h"
#include "lib/exec/ranks/rank_exec.h"
#include "lib/program/threads.h"
#include "lib/solver/step_solver.h"

namespace pbf::PBF_VARIANT {
namespace {

template <class Real>
using CpuSolver = StepSolver<Real, PeriodicExec<RankExec<CpuExec>>>;

}  // namespace

std::unique_ptr<Solver> make_cpu_solver(const Scene& scene, const Plan& plan, Particles particles,
                                        Communicator* ranks) try {
  const int threads = solver_threads(scene, plan.particles), entries = cpu_list_entries(scene);
  const bool periodic = !scene.domain.periodic.empty();
  require_threads(threads);
  if (scene.precision == Precision::dbl)
    return std::make_unique<CpuSolver<double>>(scene, plan, std::move(particles), periodic, ranks,
                                               threads, entries);
  return std::make_unique<CpuSolver<float>>(scene, plan, std::move(particles), periodic, ranks,
                                            threads, entries);
} catch (const std::bad_alloc&) {
  throw Error(ExitCode::unavailable, "not enough memory for " + std::to_string(plan.particles) +
                                         " particles; increase fluid.spacing, or use a machine "
                                         "with more memory (pbf plan says how much)");
}

}  // namespace pbf::PBF_VARIANT
