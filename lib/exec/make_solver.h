// Creates a solver for the backend of a scene.
#pragma once

#include <cstddef>
#include <memory>

#include "lib/exec/ranks/communicator.h"
#include "lib/program/plan.h"
#include "lib/scene/particles.h"
#include "lib/scene/scene.h"
#include "lib/solver/solver.h"

namespace pbf::exec_module {

/// Throws Error(unavailable) when the plan's peak of host memory is more than the bytes that are
/// available, which are to be asked for before any particle is read, for the peak includes them (0:
/// not known). An allocation that the system cannot back succeeds at first, and the process is
/// killed later without a word. The memory of a device is checked by make_solver.
void refuse_if_too_large(const Scene& scene, const Plan& plan, std::size_t available);

/// A solver in this process. Throws Error(unavailable) if the backend, a device or memory is
/// missing. Takes the particles and frees them during the construction. It does not prestabilize
/// them: code that runs a scene from its start calls solver_of() (lib/run/start.h). ranks: null, or
/// those of which the solver is a part (lib/exec/ranks/ranked_solver.h).
std::unique_ptr<Solver> make_solver(const Scene& scene, const Plan& plan, Particles particles,
                                    Communicator* ranks = nullptr);

}  // namespace pbf::exec_module
