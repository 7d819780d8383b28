// What is checked before a CUDA solver is made: a device, and enough of its memory.
#include <cmath>

#include "kernels/smoothing.h"
#include "lib/cuda/check.h"
#include "lib/cuda/cuda_solver.h"
#include "lib/cuda/cuda_variants.h"
#include "lib/plan/plan.h"

namespace pbf {
namespace {

/// Room for the lists at first: for the densest rest packing of the scene's h/d and a seventh more;
/// an eighth of the lists may be up to 32 entries longer. first_entries > 0: that many instead.
ListRoom first_room(const Scene& s, std::int64_t n, int first_entries) {
  const double neighbors = 4.0 / 3.0 * kPi * std::pow(s.fluid.smoothing_ratio, 3);
  const int first = first_entries > 0 ? first_entries : int(neighbors * 1.15);
  return {(first + 3) / 4, 8, int(n / 8) + 32};
}

void refuse_if_too_large(const Scene& s, const Plan& plan, ListRoom room) {
  const double real = s.precision == Precision::dbl ? 8 : 4, n = double(plan.particles);
  const double cells = double(plan.cells[0]) * plan.cells[1] * plan.cells[2];
  const double state =
      (4 * 4 + 1) * real + 7 * 4 + 16 * room.first + (plan.vorticity ? 4 * real : 0);
  const double saved = (s.guard ? 2 : 1) * (2 * 4 * real + 4), staging = s.output ? 7 * 8 : 0;
  const double bytes =
      n * (state + saved + staging) + 16.0 * room.tail * room.tails + 9 * 4 * cells;
  std::size_t free = 0, total = 0;
  PBF_CUDA_CHECK(cudaMemGetInfo(&free, &total));
  if (bytes > double(free))
    throw Error(ExitCode::unavailable,
                "not enough device memory: " + std::to_string(plan.particles) + " particles need " +
                    std::to_string(std::int64_t(bytes)) + " bytes, " + std::to_string(free) +
                    " of " + std::to_string(total) +
                    " are free; increase fluid.spacing or use --precision float");
}

}  // namespace

bool cuda_available(std::string* why) {
  int count = 0;
  const cudaError_t e = cudaGetDeviceCount(&count);
  if (e == cudaSuccess && count > 0) return true;
  if (why) *why = e == cudaSuccess ? "no CUDA device" : cudaGetErrorString(e);
  return false;
}

std::unique_ptr<Solver> make_cuda_solver(const Scene& scene, const Plan& plan,
                                         const Particles& particles, int first_entries) {
  std::string why;
  if (!cuda_available(&why))
    throw Error(ExitCode::unavailable,
                "backend cuda: no usable GPU here (" + why +
                    "); run with --backend cpu, or where `nvidia-smi` lists a device");
  const ListRoom room = first_room(scene, plan.particles, first_entries);
  refuse_if_too_large(scene, plan, room);
  return scene.solver.reproducible ? pinned::make_stepping_solver(scene, plan, particles, room)
                                   : plain::make_stepping_solver(scene, plan, particles, room);
}

}  // namespace pbf
