// Makes a CUDA solver, after checks for a device and enough of its memory.
#include <utility>

#include "lib/exec/cuda/check.h"
#include "lib/exec/cuda/cuda_solver.h"
#include "lib/exec/cuda/cuda_variants.h"
#include "lib/exec/cuda/device_link.h"
#include "lib/program/plan.h"

namespace pbf::exec_module {
namespace {

/// Uses the plan's size of the arrays. The CUDA context is already allocated, so it is not counted.
void refuse_if_device_too_small(const Scene& scene, const Plan& plan) {
  std::size_t free = 0, total = 0;
  PBF_CUDA_CHECK(cudaMemGetInfo(&free, &total));
  if (plan.memory.device_arrays > std::int64_t(free))
    throw Error(ExitCode::unavailable,
                "not enough device memory: " + std::to_string(plan.particles) + " particles need " +
                    std::to_string(plan.memory.device_arrays) + " bytes, " + std::to_string(free) +
                    " of " + std::to_string(total) + " are free; " + memory_remedy(scene, plan) +
                    " or use --precision float");
}

}  // namespace

bool cuda_available(std::string* why) {
  int count = 0;
  const cudaError_t e = cudaGetDeviceCount(&count);
  if (e == cudaSuccess && count > 0) return true;
  if (why) *why = e == cudaSuccess ? "no CUDA device" : cudaGetErrorString(e);
  return false;
}

std::unique_ptr<Solver> make_cuda_solver(const Scene& scene, const Plan& plan, Particles particles,
                                         int first_entries, Communicator* ranks) {
  std::string why;
  if (!cuda_available(&why))
    throw Error(ExitCode::unavailable,
                "backend cuda: no usable GPU here (" + why +
                    "); run with --backend cpu, or where `nvidia-smi` lists a device");
  if (ranks) use_device_of_rank(*ranks);
  refuse_if_device_too_small(scene, plan);
  const ListCapacity capacity =
      first_list_capacity(rest_neighbors(scene), plan.capacity, first_entries);
  return scene.solver.reproducible
             ? pinned::make_stepping_solver(scene, plan, std::move(particles), capacity, ranks)
             : plain::make_stepping_solver(scene, plan, std::move(particles), capacity, ranks);
}

}  // namespace pbf::exec_module
