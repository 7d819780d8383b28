#include "lib/exec/cuda/cuda_exec.cuh"
#include "lib/program/plan.h"
#include "lib/solver/step_solver.h"
#include "tests/support/emitting.h"

namespace pbf::test {

std::unique_ptr<Solver> emitting_on_cuda(const Scene& scene, const Plan& plan, Particles all) {
  const ListCapacity lists = first_list_capacity(rest_neighbors(scene), plan.capacity);
  if (scene.precision == Precision::dbl)
    return std::make_unique<StepSolver<double, CudaExec, EmittingFeatures>>(
        scene, plan, std::move(all), lists, plan.capacity, plan.capacity);
  return std::make_unique<StepSolver<float, CudaExec, EmittingFeatures>>(
      scene, plan, std::move(all), lists, plan.capacity, plan.capacity);
}

}  // namespace pbf::test
