// Finds values that look as if they were not in SI units.
#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "lib/base/text.h"
#include "lib/run/warnings.h"
#include "lib/scene/vector3.h"

namespace pbf::run_module {
namespace {

constexpr double kStrong = 200, kWeak = 0.01;      // m/s^2
constexpr double kLight = 20, kHeavy = 25000;      // kg/m^3: liquid hydrogen has 71, osmium 20000
constexpr double kFast = 500;                      // m/s
constexpr double kLong = 100, kHardlyFalls = 0.1;  // m, share of it

std::string gravity_text(const Scene& s) {
  const double g = length(s.gravity);
  if (g == 0 || (g >= kWeak && g <= kStrong)) return "";
  return fmt::format("gravity is {:.4g} m/s^2, on Earth it is 9.81", g);
}

std::string density_text(const Scene& s) {
  const double rho = s.fluid.rest_density;
  if (rho >= kLight && rho <= kHeavy) return "";
  return fmt::format(
      "fluid.rest_density is {:.4g} kg/m^3, water has 1000{}", rho,
      rho < kLight ? fmt::format(" ({:.4g} g/cm^3 are {:.4g} kg/m^3)", rho, 1000 * rho) : "");
}

std::string speed_text(const Scene& s) {
  for (std::size_t b = 0; b < s.bodies.size(); ++b)
    if (const double v = length(s.bodies[b].velocity); v > kFast)
      return fmt::format("bodies[{}].velocity is {:.4g} m/s ({:.4g} mm/s are {:.4g} m/s)", b, v, v,
                         v / 1000);
  return "";
}

std::string length_text(const Scene& s) {
  const double g = length(s.gravity), fall = 0.5 * g * s.time.end * s.time.end;
  const Double3 box = s.domain.max - s.domain.min;
  const double longest = std::max({box[0], box[1], box[2]});
  if (g == 0 || longest <= kLong || fall >= kHardlyFalls * longest) return "";
  return fmt::format(
      "domain is {:.4g} m long, and until time.end ({:.4g} s) things fall by {:.3g} m alone "
      "({:.4g} mm are {:.4g} m)",
      longest, s.time.end, fall, longest, longest / 1000);
}

std::string viscosity_text(const Scene& s) {
  if (!s.viscosity || s.viscosity->xsph <= 1) return "";
  return fmt::format(
      "viscosity.xsph is {:.4g}, a share of velocities that is stable up to 1, and no viscosity in "
      "Pa s",
      s.viscosity->xsph);
}

}  // namespace

std::string units_text(const Scene& s) {
  std::vector<std::string> found;
  for (const auto& text : {gravity_text, density_text, speed_text, length_text, viscosity_text})
    if (const std::string one = text(s); !one.empty()) found.push_back(one);
  if (found.empty()) return "";
  return joined(found, "; ") + ": are the values in SI units (m, kg, s)?";
}

}  // namespace pbf::run_module
