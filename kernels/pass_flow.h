// Flow through rectangles: counts the particles that change sides in an update.
#pragma once

#include <cstdint>

#include "kernels/atomics.h"
#include "kernels/vec3.h"

namespace pbf {

/// A rectangle in the internal frame, lengths in h; `normal` and `edge` are unit vectors.
struct FlowGate {
  double normal[3] = {1, 0, 0};
  double edge[2][3] = {{0, 1, 0}, {0, 0, 1}};
  double middle[3] = {0, 0, 0};  ///< coordinates along the normal and the edges
  double half[2] = {0, 0};       ///< half lengths of the edges
};

/// Particles that crossed the rectangle: along the normal minus against it.
struct FlowCount {
  std::int64_t total = 0;  ///< since the start
  std::int64_t since = 0;  ///< since the last reading
  double time = 0;         ///< s, since the last reading

  /// Calls f for every number, in the order of files.
  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    f(s.total), f(s.since), f(s.time);
  }
};

/// A tally (kernels/gauge_probe.h) that is made at the end of updates.
struct FlowTally {
  using Site = FlowGate;
  using Sums = FlowCount;
  static constexpr const char* sites = "gates";
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// One bit per particle and gate says on which side of the gate the particle is. The bits follow
/// from positions alone, so they are not part of a state. With `count`, a particle counts if its
/// side has changed since the last call and it is within the rectangle now.
template <class Real>
struct FlowPass {
  const FlowGate* gate;
  int gates;
  OwnRows<const Vec4<Real>> position;
  OwnRows<const int> id;
  int* sides;        ///< in/out, by id
  FlowCount* count;  ///< null: only stores the sides
  double update_dt;  ///< s

  PBF_HD void operator()(int i) const {
    if (id[i] < 0) return;  // it leaves in the next sort
    const Vec3<Real> x = xyz(position[i]);
    unsigned now = 0;
    for (int k = 0; k < gates; ++k) now |= unsigned(beyond(gate[k], x)) << k;
    unsigned before = now;
    if (count) before = unsigned(sides[id[i]]);
    sides[id[i]] = int(now);
    if (!count) return;
    if (i == 0)
      for (int k = 0; k < gates; ++k) count[k].time += update_dt;
    if (now == before) return;
    for (int k = 0; k < gates; ++k) {
      if (!((now ^ before) >> k & 1) || !within(gate[k], x)) continue;
      const std::int64_t one = now >> k & 1 ? 1 : -1;
      add_whole(&count[k].total, one);
      add_whole(&count[k].since, one);
    }
  }

 private:
  /// Uses mul_add() for equal bits in all kernels, because sides from two passes are compared.
  PBF_HD static bool beyond(const FlowGate& g, Vec3<Real> x) {
    const double along =
        mul_add(g.normal[0], double(x.x),
                mul_add(g.normal[1], double(x.y), mul_add(g.normal[2], double(x.z), -g.middle[0])));
    return along >= 0;
  }
  PBF_HD static bool within(const FlowGate& g, Vec3<Real> x) {
    for (int e = 0; e < 2; ++e) {
      const double a = g.edge[e][0] * double(x.x) + g.edge[e][1] * double(x.y) +
                       g.edge[e][2] * double(x.z) - g.middle[1 + e];
      if (!(a <= g.half[e] && a >= -g.half[e])) return false;
    }
    return true;
  }
};

}  // namespace pbf::PBF_VARIANT
