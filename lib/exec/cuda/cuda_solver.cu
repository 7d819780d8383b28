// The CUDA solver; compiled once for each variant of the arithmetic (kernels/hd.h).
#include <utility>

#include "lib/exec/cuda/cuda_exec.cuh"
#include "lib/exec/cuda/cuda_variants.h"
#include "lib/solver/step_solver.h"

namespace pbf::PBF_VARIANT {

std::unique_ptr<Solver> make_stepping_solver(const Scene& scene, const Plan& plan,
                                             Particles particles, ListCapacity capacity) {
  if (scene.precision == Precision::dbl)
    return std::make_unique<StepSolver<double, CudaExec>>(scene, plan, std::move(particles),
                                                          capacity, plan.capacity);
  return std::make_unique<StepSolver<float, CudaExec>>(scene, plan, std::move(particles), capacity,
                                                       plan.capacity);
}

}  // namespace pbf::PBF_VARIANT
