// What a measure adds up over all particles, in double on every backend and in both precisions.
#pragma once

#include <cstdint>

#include "kernels/hd.h"

namespace pbf {

/// Particles that a reduction adds in a tree before it adds such sums in order: on every backend.
constexpr int kMeasureBlock = 128;

/// Partial sums in the internal frame (h, s, rho0); lib/diag turns the total into SI units.
struct MeasureSums {
  double compression = 0, compression_squared = 0, compression_max = 0;
  double speed_squared = 0, speed_squared_max = 0;
  double x[3] = {0, 0, 0}, v[3] = {0, 0, 0}, front[3] = {-1e300, -1e300, -1e300};
  /// Particles below the eighths of the depth at rest (RestPool), each one spread over a spacing.
  static constexpr int levels = 8;
  double below[levels] = {0, 0, 0, 0, 0, 0, 0, 0};
  double penetration = 0;  ///< largest distance behind the limit where particles are clamped
  std::int64_t above_1 = 0, above_10 = 0;  ///< particles compressed by more than 1 %, 10 %
  std::int64_t neighbors = 0, neighbors_max = 0, outside = 0, non_finite = 0;
  std::int64_t fast = 0, rounds = 0;  ///< StepCounts so far
  double compression_p99 = 0;  ///< of the total only: from the histogram (compression_bins.h)

  PBF_HD void add(const MeasureSums& o) {
    const auto take_larger = [](auto& a, auto b) { a = a > b ? a : b; };
    compression += o.compression;
    compression_squared += o.compression_squared;
    take_larger(compression_max, o.compression_max);
    speed_squared += o.speed_squared;
    take_larger(speed_squared_max, o.speed_squared_max);
    for (int k = 0; k < 3; ++k) {
      x[k] += o.x[k];
      v[k] += o.v[k];
      take_larger(front[k], o.front[k]);
    }
    for (int k = 0; k < levels; ++k) below[k] += o.below[k];
    take_larger(penetration, o.penetration);
    above_1 += o.above_1;
    above_10 += o.above_10;
    neighbors += o.neighbors;
    take_larger(neighbors_max, o.neighbors_max);
    outside += o.outside;
    non_finite += o.non_finite;
    fast += o.fast;
    rounds += o.rounds;
  }
};

}  // namespace pbf
