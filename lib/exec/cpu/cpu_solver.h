// The CPU backend behind the Solver interface.
#pragma once

#include <memory>

#include "kernels/hd.h"
#include "lib/exec/ranks/communicator.h"
#include "lib/solver/solver.h"

namespace pbf::PBF_VARIANT {

/// Runs with scene.threads threads (0: solver_threads()). Throws Error(unavailable)
/// when there is not enough memory. ranks: null, or of a run on several ranks
/// (lib/exec/ranks/ranked_solver.h).
std::unique_ptr<Solver> make_cpu_solver(const Scene& scene, const Plan& plan, Particles particles,
                                        Communicator* ranks = nullptr);

}  // namespace pbf::PBF_VARIANT
