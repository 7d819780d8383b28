#include "app/options.h"

#include "lib/solver/diagnostics.h"

namespace pbf::app_module {

std::string diagnostics_text() {
  return "Diagnostics (formulas: lib/solver/DIAGNOSTICS.md; c = max(rho/rho0 - 1, 0) of a "
         "particle, "
         "walls\n"
         "included; H0 = volume of the fluid / area of the floor):\n" +
         diagnostics_help();
}

}  // namespace pbf::app_module
