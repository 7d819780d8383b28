// The step of `time.step: auto` where something moves as it is told.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// Chooses time.step anew, by gravity, bodies and motions, whose tables have been read: the fastest
/// obstacle moves by at most kSafeWay h in a step, and what a particle at rest feels in the tank
/// stands in the place of gravity. Looks at a whole period, or table: time.end has no say. Throws
/// Error(bad_input) where nothing moves, and for what does not go with the step.
void choose_step_of_motions(Scene& scene);

}  // namespace pbf::inline run_module
