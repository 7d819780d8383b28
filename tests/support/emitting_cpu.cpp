#include "lib/program/plan.h"
#include "lib/solver/step_solver.h"
#include "tests/support/emitting.h"
#include "tests/support/scalar_exec.h"

namespace pbf::test {

std::unique_ptr<Solver> emitting_on_cpu(const Scene& scene, const Plan& plan, Particles all,
                                        int threads) {
  if (scene.precision == Precision::dbl)
    return std::make_unique<StepSolver<double, ScalarExec, EmittingFeatures>>(
        scene, plan, std::move(all), threads);
  return std::make_unique<StepSolver<float, ScalarExec, EmittingFeatures>>(scene, plan,
                                                                           std::move(all), threads);
}

}  // namespace pbf::test
