#include "lib/base/error.h"
#include "lib/cpu/cpu_solver.h"
#ifdef PBF_HAS_CUDA
#include "lib/cuda/cuda_solver.h"
#endif
#include "lib/plan/plan.h"
#include "lib/solver/solver.h"

namespace pbf {

std::unique_ptr<Solver> make_solver(const Scene& scene, const Plan& plan,
                                    const Particles& particles) {
  if (scene.backend == Backend::cpu) return make_cpu_solver(scene, plan, particles);
#ifdef PBF_HAS_CUDA
  return make_cuda_solver(scene, plan, particles);
#else
  throw Error(ExitCode::unavailable,
              "this build has no CUDA backend; run with --backend cpu, or build with "
              "-DPBF_CUDA=ON where a CUDA toolkit is installed");
#endif
}

}  // namespace pbf
