// A pressure gauge: a disc on a surface, which takes its share of the surface's load.
#pragma once

#include "kernels/vec3.h"

namespace pbf {

/// Lengths in h, in the internal frame.
struct Patch {
  int wall = 0;                                         ///< number of its wall in LoadBook
  int row = 0;                                          ///< row of its own sums
  double center[3] = {0, 0, 0}, normal[3] = {0, 0, 1};  ///< into the fluid
  /// The share of a particle falls from 1 at radius - soft to 0 at radius + soft. A sharp edge
  /// would make readings scatter (kernels/README.md, "Gauges").
  double radius = 1, soft = 0.5;
  /// Of a round surface: radius `bend` (0: the surface is flat) and the unit vector `axis`, which
  /// extends from `low` to `high` about `middle`; for a ball these are 0.
  double bend = 0, middle[3] = {0, 0, 0}, axis[3] = {0, 0, 0}, low = 0, high = 0;
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// 1 within the disc, 0 outside, by the distance from its middle.
PBF_HD double patch_share(const Patch& p, double distance_squared) {
  const double most = p.radius + p.soft;
  if (!(distance_squared < most * most)) return 0;
  const double share = (most - square_root(distance_squared)) / (2 * p.soft);
  return share < 1 ? share : 1;
}

/// h: the part of displacement `way`, which the surface has given a particle at x, that is along
/// the normal and belongs to the disc.
template <class Real>
PBF_HD double patch_way(const Patch& p, Vec3<Real> x, Vec3<Real> way) {
  const double away =
      double(way.x) * p.normal[0] + double(way.y) * p.normal[1] + double(way.z) * p.normal[2];
  double d[3] = {double(x.x) - p.center[0], double(x.y) - p.center[1], double(x.z) - p.center[2]};
  if (p.bend > 0) {  // d: from the center to the surface
    double foot[3] = {double(x.x) - p.middle[0], double(x.y) - p.middle[1],
                      double(x.z) - p.middle[2]};
    const double z = foot[0] * p.axis[0] + foot[1] * p.axis[1] + foot[2] * p.axis[2];
    const double s = max2(min2(z, p.high), p.low);
    for (int k = 0; k < 3; ++k) foot[k] -= s * p.axis[k];
    const double r = square_root(foot[0] * foot[0] + foot[1] * foot[1] + foot[2] * foot[2]);
    const double in = r > 1e-12 ? 1 - p.bend / r : 0;
    for (int k = 0; k < 3; ++k) d[k] -= in * foot[k];
    if (!(foot[0] * p.normal[0] + foot[1] * p.normal[1] + foot[2] * p.normal[2] > 0)) return 0;
  }
  const double above = d[0] * p.normal[0] + d[1] * p.normal[1] + d[2] * p.normal[2];
  // Behind a flat face, only particles that it has sent back belong to it.
  if (!(p.bend > 0) && above < 0 && !(away > 0)) return 0;
  double across = 0;
  for (int k = 0; k < 3; ++k) {
    const double e = d[k] - above * p.normal[k];
    across += e * e;
  }
  return away * patch_share(p, across);
}

}  // namespace pbf::PBF_VARIANT
