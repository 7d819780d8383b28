// The potential energy that fluid at rest cannot lose.
#pragma once

#include "lib/program/plan.h"

namespace pbf::program_module {

/// J, above the lowest corner of the box as Diagnostics::energy: the potential energy of the fluid
/// at rest on the floor, at its rest density, around the obstacles where they are at the start. By
/// sampling, to about 1e-3 of it. NaN where nothing holds the fluid: without gravity, or with an
/// open face that is not above it, and where particles come and go.
double energy_at_rest(const Scene& scene, const Plan& plan);

}  // namespace pbf::program_module
