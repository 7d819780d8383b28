// Values that look as if they were not in SI units.
#pragma once

#include <string>

#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// What to say of gravity above 200 or below 0.01 m/s^2, of a rest density that no liquid has, of a
/// body faster than 500 m/s, of viscosity.xsph above 1, and of a domain longer than 100 m in which
/// gravity moves nothing by a tenth of that during the run; empty: nothing. Allowed they all are:
/// tests go far on purpose, and so may others.
std::string units_text(const Scene& scene);

}  // namespace pbf::inline run_module
