// The step of `time.step: auto` in scenes with prescribed motions.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// Chooses time.step from gravity, bodies and motions, after the tables have been read: the fastest
/// obstacle moves by at most kSafeWay h in a step, and the acceleration of a particle at rest in
/// the tank takes the place of gravity. Covers a whole period or table, whatever time.end is.
/// Throws Error(bad_input) if nothing moves, and if the scene violates a rule with this step.
void choose_step_of_motions(Scene& scene);

}  // namespace pbf::inline run_module
