// The CUDA backend behind the Solver interface. No CUDA header is needed to include this.
#pragma once

#include <memory>

#include "lib/exec/ranks/communicator.h"
#include "lib/solver/solver.h"

namespace pbf::exec_module {

/// Runs on the current device (CUDA_VISIBLE_DEVICES chooses). Throws Error(unavailable) where there
/// is no driver, no device, or not enough memory on it (with required and available bytes).
/// first_entries: capacity per neighbor list at the start, for tests; 0: from the scene. ranks:
/// null, or of a run on several ranks (lib/exec/ranks/ranked_solver.h), which use the devices of a
/// machine in turns.
std::unique_ptr<Solver> make_cuda_solver(const Scene& scene, const Plan& plan, Particles particles,
                                         int first_entries = 0, Communicator* ranks = nullptr);

/// Whether a device can be used. `why`: what is missing.
bool cuda_available(std::string* why = nullptr);

}  // namespace pbf::exec_module
