// The energy that passes take out of the motion of the particles, summed over a run. Sums are whole
// numbers, so that neither order nor threads change a bit.
#pragma once

#include "kernels/atomics.h"
#include "kernels/vec3.h"

namespace pbf {

/// A sum in units of kDissipationUnits: whole * 2^27 + rest.
struct DissipationSum {
  static constexpr int bits = 27;
  std::int64_t whole = 0, rest = 0;

  /// Calls f for every number. Saved numbers are small enough to be exact as double.
  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    if constexpr (requires { s.whole = 0; }) {
      f(s.whole), f(s.rest);
    } else {
      const std::int64_t whole = s.whole + (s.rest >> bits);
      const std::int64_t rest = s.rest & ((std::int64_t(1) << bits) - 1);
      f(whole), f(rest);
    }
  }
};

/// Units per (h/time.step)^2, the unit of energies per mass, and the most that a pass books for a
/// particle, in this unit.
inline constexpr double kDissipationUnits = 0x1p44, kMostDissipation = 0x1p10;
/// Sums per cause, a power of two: so many that threads that work on different particles seldom
/// meet at one.
constexpr int dissipation_sums(std::int64_t particles) {
  int n = 1;
  while (n < 1024 && 256 * std::int64_t(n) < particles) n *= 2;
  return n;
}

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// Books what a pass takes from particles. Without sums it books nothing.
struct DissipationBook {
  DissipationSum* sums = nullptr;  ///< those of a cause; in/out
  int last = 0;                    ///< number of sums less 1
  double inv_unit = 0;             ///< s^2/h^2, of what add() gets

  /// taken: h^2/s^2 per mass of the particle in row i; negative if the pass gave it.
  PBF_HD void add(int i, double taken) const {
    if (sums) add_units(i, units(taken));
  }
  /// The same for a group of adjacent rows (kernels/lanes.h), whose number divides 256: one
  /// addition for all. A processor takes tens of cycles for each.
  template <class Group, class V>
  requires(V::width > 0) PBF_HD void add(Group rows, const V& taken) const {
    if (!sums) return;
    std::int64_t all = 0;
    for (int l = 0; l < V::width; ++l) all += units(taken.v[l]);
    add_units(rows[0], all);
  }

 private:
  PBF_HD std::int64_t units(double taken) const {
    const double x = taken * inv_unit;
    // Not for NaN.
    const double bounded = x < -kMostDissipation  ? -kMostDissipation
                           : x > kMostDissipation ? kMostDissipation
                           : x == x               ? x
                                                  : 0;
    return std::int64_t(bounded * kDissipationUnits);
  }
  PBF_HD void add_units(int i, std::int64_t term) const {
    constexpr int bits = DissipationSum::bits;
    DissipationSum& sum = sums[(i >> 8) & last];
    const std::int64_t t = sum_of_warp(&sum, term);
    if (const std::int64_t whole = t >> bits; whole != 0) add_whole(&sum.whole, whole);
    if (const std::int64_t rest = t & ((std::int64_t(1) << bits) - 1); rest != 0)
      add_whole(&sum.rest, rest);
  }
};

/// h^2/s^2: the kinetic energy per mass that the change from v to `now` takes.
template <class Real>
PBF_HD double energy_taken(Vec3<Real> v, Vec3<Real> now) {
  return 0.5 * double(dot(v - now, v + now));
}

}  // namespace pbf::PBF_VARIANT
