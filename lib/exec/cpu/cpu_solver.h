// The CPU backend behind the Solver interface.
#pragma once

#include <memory>

#include "kernels/hd.h"
#include "lib/solver/solver.h"

namespace pbf::PBF_VARIANT {

/// Runs with scene.threads threads (0: solver_threads()). Throws Error(unavailable)
/// when there is not enough memory.
std::unique_ptr<Solver> make_cpu_solver(const Scene& scene, const Plan& plan, Particles particles);

}  // namespace pbf::PBF_VARIANT
