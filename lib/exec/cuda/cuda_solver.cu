// The CUDA solver; compiled once for each variant of the arithmetic (kernels/hd.h).
#include <utility>

#include "lib/exec/cuda/cuda_exec.cuh"
#include "lib/exec/cuda/cuda_variants.h"
#include "lib/exec/periodic/periodic_exec.h"
#include "lib/exec/ranks/rank_exec.h"
#include "lib/solver/step_solver.h"

namespace pbf::PBF_VARIANT {
namespace {

template <class Real>
using CudaSolver = StepSolver<Real, PeriodicExec<RankExec<CudaExec>>>;

}  // namespace

std::unique_ptr<Solver> make_stepping_solver(const Scene& scene, const Plan& plan,
                                             Particles particles, ListCapacity capacity,
                                             Communicator* ranks) {
  const bool periodic = !scene.domain.periodic.empty();
  const std::int64_t total = ranks ? plan.particles : plan.capacity;
  if (scene.precision == Precision::dbl)
    return std::make_unique<CudaSolver<double>>(scene, plan, std::move(particles), periodic, ranks,
                                                capacity, total, plan.capacity);
  return std::make_unique<CudaSolver<float>>(scene, plan, std::move(particles), periodic, ranks,
                                             capacity, total, plan.capacity);
}

}  // namespace pbf::PBF_VARIANT
