// Finds values that look as if they were not in SI units.
#pragma once

#include <string>

#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// Text about gravity above 200 or below 0.01 m/s^2, a rest density that no liquid has, a body
/// faster than 500 m/s, viscosity.xsph above 1, and a domain longer than 100 m in which gravity
/// moves nothing by a tenth of its length during the run; empty if there is none. All these values
/// are allowed.
std::string units_text(const Scene& scene);

}  // namespace pbf::inline run_module
