// Obstacles with the boxes around them that tell passes which particles they do not concern.
#pragma once

#include <cmath>
#include <vector>

#include "kernels/boundary/solids.h"

namespace pbf::inline PBF_VARIANT {

/// With the box, h, beyond which it is neither met nor felt: farther than the range of the walls'
/// density, and half a cell for what rounding may add.
template <class Real>
PlacedSolid<Real> placed(const Solid<double>& s, const Box<Real>& walls) {
  PlacedSolid<Real> out;
  out.solid.shape = s.shape;
  const auto cast = [](const Vec3<double>& v) {
    return Vec3<Real>{Real(v.x), Real(v.y), Real(v.z)};
  };
  out.solid.center = cast(s.center);
  out.solid.half = cast(s.half);
  out.solid.through = s.through;
  const double range = 1 / double(walls.inv_range) + 0.5, far = 1e9;
  const double center[3] = {s.center.x, s.center.y, s.center.z};
  const double half[3] = {s.half.x, s.half.y, s.half.z};
  double low[3], high[3];
  for (int k = 0; k < 3; ++k) {
    double down = range, up = range;
    for (int axis = 0; axis < 3; ++axis) {
      out.solid.turn[axis][k] = Real(s.turn[axis][k]);
      const double t = s.turn[axis][k];
      switch (s.shape) {
        case ObstacleShape::plane:  // ends where its face is, if that is along two axes
          if (axis == 2) {
            down = t == -1 ? range : far;
            up = t == 1 ? range : far;
          }
          break;
        case ObstacleShape::sphere:
          break;
        case ObstacleShape::box:
        case ObstacleShape::cylinder:
        case ObstacleShape::capsule:
          if (t == 0 || (s.shape != ObstacleShape::box && axis != 2)) break;
          const bool lower = s.through >> 2 * axis & 1, upper = s.through >> 2 * axis & 2;
          down += std::fabs(t) * ((t > 0 ? lower : upper) ? far : half[axis]);
          up += std::fabs(t) * ((t > 0 ? upper : lower) ? far : half[axis]);
          break;
      }
    }
    const bool round = s.shape != ObstacleShape::plane && s.shape != ObstacleShape::box;
    low[k] = center[k] - down - (round ? half[0] : 0);
    high[k] = center[k] + up + (round ? half[0] : 0);
  }
  out.bounds = {cast({low[0], low[1], low[2]}), cast({high[0], high[1], high[2]})};
  return out;
}

template <class Real>
std::vector<PlacedSolid<Real>> placed_solids(const std::vector<Solid<double>>& solids,
                                             const Box<Real>& walls) {
  std::vector<PlacedSolid<Real>> all;
  for (const Solid<double>& s : solids) all.push_back(placed(s, walls));
  return all;
}

/// Around all of them.
template <class Real>
Bounds<Real> bounds_of(const std::vector<PlacedSolid<Real>>& all) {
  Bounds<Real> out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Bounds<Real>& b = all[k].bounds;
    if (k == 0) out = b;
    out.low = {min2(out.low.x, b.low.x), min2(out.low.y, b.low.y), min2(out.low.z, b.low.z)};
    out.high = {max2(out.high.x, b.high.x), max2(out.high.y, b.high.y), max2(out.high.z, b.high.z)};
  }
  return out;
}

}  // namespace pbf::inline PBF_VARIANT
