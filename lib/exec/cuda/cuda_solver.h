// The CUDA backend behind the Solver interface. No CUDA header is needed to include this.
#pragma once

#include <memory>

#include "lib/solver/solver.h"

namespace pbf::exec_module {

/// Runs on the current device (CUDA_VISIBLE_DEVICES chooses). Throws Error(unavailable) where there
/// is no driver, no device, or not enough memory on it (with required and available bytes).
/// first_entries: capacity per neighbor list at the start, for tests; 0: from the scene.
std::unique_ptr<Solver> make_cuda_solver(const Scene& scene, const Plan& plan, Particles particles,
                                         int first_entries = 0);

/// Whether a device can be used. `why`: what is missing.
bool cuda_available(std::string* why = nullptr);

}  // namespace pbf::exec_module
