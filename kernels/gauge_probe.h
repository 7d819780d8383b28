// Sums over the particles around points, for gauges of levels, lines and velocities. The sums are
// integers, so order and threads do not matter. Every particle adds its own terms without cells, so
// a reading needs no sort.
#pragma once

#include <cstdint>

#include "kernels/atomics.h"
#include "kernels/vec3.h"

namespace pbf {

/// A row of points along a line, in h, in the internal frame.
struct Probe {
  static constexpr int inclined = 3;  ///< the axis of a line that has its own direction

  double from[3] = {0, 0, 0};       ///< the first point
  double step = 1;                  ///< spacing of the points
  double direction[3] = {0, 0, 0};  ///< unit vector; of inclined lines only
  double scale = 1;                 ///< 1/h: particles within 1/scale of a point count
  int axis = 2, count = 1;
  int first = 0;        ///< number of its first point among those of all probes
  bool moving = false;  ///< velocities are summed too
};

/// Units per 1, or per h, in ProbeSums.
inline constexpr std::int64_t kProbeUnits = std::int64_t(1) << 32;

/// Of one point: the sum of (1 - q^2)^3 (the shape of Poly6) in units of 1/kProbeUnits, and the sum
/// of this times v dt in units of h/kProbeUnits, with dt of an update.
struct ProbeSums {
  std::int64_t weight = 0, way[3] = {0, 0, 0};
};

/// A tally: a way to make the sums behind the readings of gauges. This one is made at a reading by
/// gauge_pass().
struct ProbeTally {
  using Site = Probe;  ///< what the kernels know of a gauge
  using Sums = ProbeSums;
  static constexpr const char *sites = "probes", *sums = "probe sums";  ///< names of their arrays
  static constexpr bool reads_velocity = true;
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

template <class Real>
struct ProbePass {
  const Probe* probe;
  int probes;
  const Vec4<Real>*position, *velocity;
  double update_dt;  ///< s
  ProbeSums* sums;   ///< in/out

  PBF_HD void operator()(int i) const {
    const Vec4<Real> at = position[i];
    for (int k = 0; k < probes; ++k) {
      const Probe& p = probe[k];
      if (p.axis == Probe::inclined) {
        around_line(p, i, at);
        continue;
      }
      // Most particles are out of range along the first axis that is tested.
      const double a =
          p.scale * (p.axis == 0 ? double(at.y) - p.from[1] : double(at.x) - p.from[0]);
      if (a < 1 && a > -1) around(p, i, at, a);
    }
  }

 private:
  PBF_HD void around_line(const Probe& p, int i, const Vec4<Real>& at) const {
    const double x = double(at.x) - p.from[0], y = double(at.y) - p.from[1],
                 z = double(at.z) - p.from[2];
    const double along = x * p.direction[0] + y * p.direction[1] + z * p.direction[2];
    spread(p, i, x * x + y * y + z * z - along * along, along);
  }
  /// a: distance from the row of points along the first axis across it, times scale.
  PBF_HD void around(const Probe& p, int i, const Vec4<Real>& at, double a) const {
    const double b = p.scale * (p.axis == 2 ? double(at.y) - p.from[1] : double(at.z) - p.from[2]);
    const double along = p.scale * (p.axis == 0   ? double(at.x) - p.from[0]
                                    : p.axis == 1 ? double(at.y) - p.from[1]
                                                  : double(at.z) - p.from[2]);
    spread(p, i, a * a + b * b, along);
  }
  /// across: squared distance from the line, times scale^2; along: of the foot on it, times scale.
  PBF_HD void spread(const Probe& p, int i, double across, double along) const {
    // Also true for NaN.
    if (!(across < 1) || !(along > -1) || !(along < p.step * (p.count - 1) + 1)) return;
    const double reach = square_root(1 - across);
    const int low = int((along - reach) / p.step), high = int((along + reach) / p.step) + 1;
    for (int n = max2(low, 0); n <= min2(high, p.count - 1); ++n) {
      const double e = along - n * p.step, t = 1 - (across + e * e);
      if (t > 0) add(p, p.first + n, i, t * t * t);
    }
  }
  PBF_HD void add(const Probe& p, int place, int i, double weight) const {
    add_whole(&sums[place].weight, whole(weight));
    if (!p.moving) return;
    const Vec4<Real> v = velocity[i];
    add_whole(&sums[place].way[0], whole(weight * bounded(update_dt * double(v.x))));
    add_whole(&sums[place].way[1], whole(weight * bounded(update_dt * double(v.y))));
    add_whole(&sums[place].way[2], whole(weight * bounded(update_dt * double(v.z))));
  }
  /// Limited to 4096 h per update. The guard detects faster and non-finite particles.
  PBF_HD static double bounded(double way) { return max2(min2(way, 4096.0), -4096.0); }
  PBF_HD static std::int64_t whole(double x) {
    const double u = x * double(kProbeUnits);
    return std::int64_t(u + (u < 0 ? -0.5 : 0.5));
  }
};

/// Adds to the sums of the gauges of a tally. An overload for each type of sites.
template <class Real>
ProbePass<Real> gauge_pass(const Probe* probe, int probes, const Vec4<Real>* position,
                           const Vec4<Real>* velocity, double update_dt, ProbeSums* sums) {
  return {probe, probes, position, velocity, update_dt, sums};
}

}  // namespace pbf::PBF_VARIANT
