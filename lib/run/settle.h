// Lets the fluid come to rest before the run begins.
#pragma once

#include <functional>
#include <string>

#include "lib/run/start.h"

namespace pbf::run_module {

/// Kinetic energy that settled fluid may have, as a share of energy_scale(). Above, a warning of
/// the kind "unsettled" is given.
inline constexpr double kSettled = 1e-3;

/// For a scene with `settle`, moves the particles of the start to where they rest in
/// settling_scene() (lib/program/settling.h), with their velocities as they were, and tells in
/// start.notes and start.warnings how calm they were. Nothing to do without the key. The bits do
/// not depend on threads, nor with solver.reproducible on the backend. `progress` gets a line now
/// and then; stop() is asked as often. Returns false if it has stopped; `start` is as it was
/// then. Throws Error(guard) if the fluid is not finite, and as make_solver() does.
bool settle(Start& start, const std::function<void(const std::string&)>& progress = {},
            const std::function<bool()>& stop = {});

}  // namespace pbf::run_module
