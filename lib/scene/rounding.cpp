#include "lib/scene/rounding.h"

#include <algorithm>
#include <cmath>

namespace pbf::scene_module {
namespace {

/// Distance between adjacent floating-point numbers near x, with `digits` fraction bits.
double number_spacing(double x, int digits) { return std::ldexp(1.0, std::ilogb(x) - digits); }

int digits_of(const Scene& s) { return s.precision == Precision::dbl ? 52 : 23; }

}  // namespace

double position_spacing(const Scene& s) {
  double spacing = 0;
  for (std::size_t a = 0; a < 3; ++a)
    if (s.dimensions == 3 || a != 1)
      spacing = std::max(spacing,
                         number_spacing((s.domain.max[a] - s.domain.min[a]) / s.h(), digits_of(s)));
  return spacing;
}

Rounding rounding_of(const Scene& s) {
  const int digits = digits_of(s);
  const double h = s.h(), dt = s.time.step / s.solver.substeps;
  const bool falls = s.gravity != Double3{};
  Rounding worst;
  worst.spacing = position_spacing(s);
  const auto take = [&](double distance, double lost, double slow) {
    worst.slow = std::max(worst.slow, slow);
    lost = std::min(lost, distance);
    if (lost > kLargestLoss * distance && lost > worst.lost) {
      worst.lost = lost;
      worst.distance = distance;
    }
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const double extent = (s.domain.max[a] - s.domain.min[a]) / h;
    const double spacing = number_spacing(extent, digits);
    if (s.dimensions == 2 && a == 1) continue;
    const double g = std::fabs(s.gravity[a]) / h;
    if (g > 0) {
      const double time = std::min(s.time.end, std::sqrt(2 * extent / g));
      take(0.5 * g * time * time, spacing * spacing / (8 * g * dt * dt),
           std::ldexp(time / dt, -digits - 1) / 4);
    }
    for (const Body& b : s.bodies) {
      const double v = std::fabs(b.velocity[a]) / h;
      if (falls || v == 0) continue;
      const double distance = std::min(v * s.time.end, extent);
      take(distance, distance * spacing / (2 * v * dt), 0);
    }
  }
  return worst;
}

}  // namespace pbf::scene_module
