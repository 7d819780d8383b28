// Creates a solver for the backend of a scene.
#pragma once

#include <memory>

#include "lib/program/plan.h"
#include "lib/scene/particles.h"
#include "lib/scene/scene.h"
#include "lib/solver/solver.h"

namespace pbf::inline exec_module {

/// Throws Error(unavailable) if the plan's peak of host memory exceeds what is available: an
/// allocation that the system cannot back succeeds at first, and the process is killed later
/// without a message. make_solver() checks the memory of a device.
void refuse_if_too_large(const Scene& scene, const Plan& plan);

/// Throws Error(unavailable) if the backend, a device or memory is missing. Takes the particles and
/// frees them during the construction. It does not prestabilize them: code that runs a scene from
/// its start calls solver_of() (lib/run/start.h).
std::unique_ptr<Solver> make_solver(const Scene& scene, const Plan& plan, Particles particles);

}  // namespace pbf::inline exec_module
