// What a measure finds out about all particles, in double on every backend and in both precisions.
// Nothing here depends on the order of the particles, on threads, blocks or backends: maxima and
// counts come first, then sums of integers (fixed_sum.h) in units that follow from the maxima.
#pragma once

#include <cstdint>

#include "kernels/fixed_sum.h"

namespace pbf {

/// Maxima and counts, in the internal frame (h, s, rho0).
struct MeasureCounts {
  double compression_max = 0, speed_squared_max = 0;
  double x_size[3] = {0, 0, 0}, v_size[3] = {0, 0, 0};  ///< largest magnitudes
  double front[3] = {-1e300, -1e300, -1e300};
  double penetration = 0;  ///< largest distance behind the limit where particles are clamped
  std::int64_t above_1 = 0, above_10 = 0;  ///< particles compressed by more than 1 %, 10 %
  std::int64_t neighbors = 0, neighbors_max = 0, outside = 0, non_finite = 0;
  std::int64_t fast = 0, rounds = 0, unresolved = 0;  ///< StepCounts so far
  double way_squared = 0;                             ///< the same

  PBF_HD void add(const MeasureCounts& o) {
    const auto take_larger = [](auto& a, auto b) { a = a > b ? a : b; };
    take_larger(compression_max, o.compression_max);
    take_larger(speed_squared_max, o.speed_squared_max);
    for (int k = 0; k < 3; ++k) {
      take_larger(x_size[k], o.x_size[k]);
      take_larger(v_size[k], o.v_size[k]);
      take_larger(front[k], o.front[k]);
    }
    take_larger(penetration, o.penetration);
    above_1 += o.above_1;
    above_10 += o.above_10;
    neighbors += o.neighbors;
    take_larger(neighbors_max, o.neighbors_max);
    outside += o.outside;
    non_finite += o.non_finite;
    fast += o.fast;
    rounds += o.rounds;
    unresolved += o.unresolved;
    take_larger(way_squared, o.way_squared);
  }
};

/// Exponents of the units: every term of a quantity is below 2^e.
struct MeasureUnits {
  int compression = 0, speed_squared = 0, x[3] = {0, 0, 0}, v[3] = {0, 0, 0};
  MeasureUnits() = default;
  PBF_HD explicit MeasureUnits(const MeasureCounts& c)
      : compression(exponent_above(c.compression_max)),
        speed_squared(exponent_above(c.speed_squared_max)) {
    for (int k = 0; k < 3; ++k) {
      x[k] = exponent_above(c.x_size[k]);
      v[k] = exponent_above(c.v_size[k]);
    }
  }
};

/// The sums, in these units; the squares of compressions in the square of theirs.
struct MeasureTerms {
  /// Particles below the eighths of the depth at rest (RestPool), each one spread over a spacing.
  static constexpr int levels = 8;
  FixedSum compression, compression_squared, speed_squared, x[3], v[3], below[levels];

  PBF_HD void add(const MeasureTerms& o) {
    compression.add(o.compression);
    compression_squared.add(o.compression_squared);
    speed_squared.add(o.speed_squared);
    for (int k = 0; k < 3; ++k) {
      x[k].add(o.x[k]);
      v[k].add(o.v[k]);
    }
    for (int k = 0; k < levels; ++k) below[k].add(o.below[k]);
  }
};

/// All of it as numbers; lib/solver/step_solver.cpp turns them into SI units.
struct MeasureSums : MeasureCounts {
  static constexpr int levels = MeasureTerms::levels;
  double compression = 0, compression_squared = 0, speed_squared = 0;
  double x[3] = {0, 0, 0}, v[3] = {0, 0, 0}, below[levels] = {0, 0, 0, 0, 0, 0, 0, 0};
  double compression_p99 = 0;  ///< from the histogram (compression_bins.h)

  MeasureSums() = default;
  MeasureSums(const MeasureCounts& c, const MeasureTerms& t) : MeasureCounts(c) {
    const MeasureUnits unit(c);
    compression = value_of(t.compression, unit.compression);
    compression_squared = value_of(t.compression_squared, 2 * unit.compression);
    speed_squared = value_of(t.speed_squared, unit.speed_squared);
    for (int k = 0; k < 3; ++k) {
      x[k] = value_of(t.x[k], unit.x[k]);
      v[k] = value_of(t.v[k], unit.v[k]);
    }
    for (int k = 0; k < levels; ++k) below[k] = value_of(t.below[k], 0);
  }
};

}  // namespace pbf
