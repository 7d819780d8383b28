// How often and how strongly hyperviscosity acts (kernels/README.md, "Second order in time").
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "lib/program/levels.h"
#include "lib/program/time_order.h"

namespace pbf::program_module {

/// The default rates in second order: with them, fluid at rest is about as calm as in first order.
/// Levels move all particles of a cell alike, so from cell to cell they stir the particles.
inline constexpr double kHyperviscosity = 1, kHyperviscosityWithLevels = 4;
/// v0 in units of sqrt(g h): differences that are larger than in fluid that comes to rest are left.
inline constexpr double kCalmSpeed = 0.05;

/// m/s^2, with the same bits for any order of the axes.
inline double gravity_of(const Scene& s) {
  std::array g{s.gravity[0] * s.gravity[0], s.gravity[1] * s.gravity[1],
               s.gravity[2] * s.gravity[2]};
  std::ranges::sort(g);
  return std::sqrt(g[0] + g[1] + g[2]);
}

/// The rate in units of sqrt(g/h), 0 where there is none. Without gravity nothing is at rest under
/// pressure.
inline double hyperviscosity_rate(const Scene& s) {
  if (s.solver.iterations == 0 || gravity_of(s) == 0) return 0;
  return s.solver.hyperviscosity.value_or(!is_second_order(s) ? 0
                                          : has_levels(s)     ? kHyperviscosityWithLevels
                                                              : kHyperviscosity);
}

/// It acts every `every` updates with the factor that makes up for the pause: what it damps changes
/// little within sqrt(h/g), and the two passes over pairs then cost little. Rates above 1 make the
/// pause shorter.
struct Hyperviscosity {
  int every = 0;      ///< updates; a power of two. 0: it never acts
  double factor = 0;  ///< c of HyperviscosityPass, at most 1
};
inline Hyperviscosity hyperviscosity_of(const Scene& s) {
  constexpr double pause = 0.5;  // sqrt(h/g), about
  const double rate = hyperviscosity_rate(s);
  if (!(rate > 0)) return {};
  const double step = s.time.step * std::sqrt(gravity_of(s) / s.h());
  const double power = std::round(std::log2(pause / (step * std::max(rate, 1.0))));
  const int every = 1 << int(std::clamp(power, 0.0, 20.0));
  return {every, std::min(rate * every * step, 1.0)};
}

}  // namespace pbf::program_module
