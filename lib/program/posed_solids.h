// Obstacles with bounding boxes. Passes use the boxes to skip particles that are far away.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/boundary/far_boundary.h"
#include "kernels/cell_index.h"
#include "lib/scene/scene.h"

namespace pbf::PBF_VARIANT {

/// With a bounding box in h. Particles outside of it neither touch the solid nor feel its density.
template <class Real>
PosedSolid<Real> placed(const Solid<double>& s, const Box<Real>& walls) {
  PosedSolid<Real> out;
  out.solid.shape = s.shape.with(
      [](const auto& shape) { return SomeShape<Real>(shape.template scaled<Real>(1)); });
  out.solid.center = scaled<Real>(s.center, 1);
  const double range = 1 / double(walls.inv_range) + kNearRoom;
  out.reach = Real(range);
  double low[3], high[3];
  const double center[3] = {s.center.x, s.center.y, s.center.z};
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) out.solid.turn[axis][k] = Real(s.turn[axis][k]);
    const Vec3<double> up{double(k == 0), double(k == 1), double(k == 2)};
    low[k] = center[k] - reach_along(s, -1.0 * up, true) - range;
    high[k] = center[k] + reach_along(s, up, true) + range;
  }
  out.bounds = {scaled<Real>(Vec3<double>{low[0], low[1], low[2]}, 1),
                scaled<Real>(Vec3<double>{high[0], high[1], high[2]}, 1)};
  return out;
}

template <class Real>
std::vector<PosedSolid<Real>> placed_solids(const std::vector<Solid<double>>& solids,
                                            const Box<Real>& walls) {
  std::vector<PosedSolid<Real>> all;
  for (const Solid<double>& s : solids) all.push_back(placed(s, walls));
  return all;
}

/// The region that is far from all walls.
template <class Real>
Bounds<Real> clear_of(const Box<Real>& walls) {
  const Real reach = Real(1) / walls.inv_range + walls.margin + Real(kNearRoom), open(1e30);
  const auto low = [&](unsigned wall) { return walls.walls & wall ? reach : -open; };
  const auto high = [&](unsigned wall, Real end) {
    return walls.walls & wall ? end - reach : open;
  };
  return {{low(x_min), low(y_min), low(z_min)},
          {high(x_max, walls.extent.x), high(y_max, walls.extent.y), high(z_max, walls.extent.z)}};
}

template <class Real>
Bounds<Real> around_both(const Bounds<Real>& a, const Bounds<Real>& b) {
  return {{min2(a.low.x, b.low.x), min2(a.low.y, b.low.y), min2(a.low.z, b.low.z)},
          {max2(a.high.x, b.high.x), max2(a.high.y, b.high.y), max2(a.high.z, b.high.z)}};
}
/// The bounding box of all solids.
template <class Real>
Bounds<Real> bounds_of(const std::vector<PosedSolid<Real>>& all) {
  Bounds<Real> out;
  for (std::size_t k = 0; k < all.size(); ++k)
    out = k == 0 ? all[k].bounds : around_both(out, all[k].bounds);
  return out;
}

/// The half cells of the grid in which particles can be near solids, in the order of their bins.
/// solids: those at rest; swept: bounds of the moving ones in the run. Empty (no restriction) with
/// open faces, because particles outside of the grid then share cells with those inside.
template <class Real>
std::vector<int> half_cells_near_solids(const Scene& scene,
                                        const std::vector<Solid<double>>& solids,
                                        const std::vector<Bounds<Real>>& swept,
                                        const Params<Real>& p, const Bounds<Real>& clear,
                                        bool booked) {
  std::vector<int> cells;
  if (!scene.domain.is_closed()) return cells;
  const bool flat = p.dimensions == 2;
  const double edge = 1 / double(p.inv_cell), rounding = 1e-3;
  // Half the edges of a half cell.
  const double half[3] = {edge / 4, flat ? 0 : edge / 2, edge / 2};
  const double reach = 1 / double(p.boundary.inv_range) + kNearRoom + rounding +
                       std::hypot(half[0], half[1], half[2]);
  const Vec3<double> around{half[0] + rounding, half[1] + rounding, half[2] + rounding};
  const auto near = [&](const Vec3<double>& m) {
    const auto beyond = [&](double x, double h, double low, double high) {
      return x - h < low + rounding || x + h > high - rounding;
    };
    if (booked && (beyond(m.x, half[0], double(clear.low.x), double(clear.high.x)) ||
                   beyond(m.y, half[1], double(clear.low.y), double(clear.high.y)) ||
                   beyond(m.z, half[2], double(clear.low.z), double(clear.high.z))))
      return true;
    for (const Bounds<Real>& b : swept)
      if (b.meets(scaled<Real>(m - around, 1), scaled<Real>(m + around, 1))) return true;
    return std::any_of(solids.begin(), solids.end(), [&](const Solid<double>& s) {
      return (flat ? distance<2>(s, m) : distance<3>(s, m)) < reach;
    });
  };
  int n = 0;
  for (int z = 0; z < p.cells_z; ++z)
    for (int y = 0; y < p.cells_y; ++y)
      for (int x = 0; x < p.cells_x; ++x, ++n) {
        const Vec3<double> middle{(x + 0.5) * edge / 2, flat ? 0 : (y + 0.5) * edge,
                                  (z + 0.5) * edge};
        if (near(middle)) cells.push_back(n);
      }
  return cells;
}

}  // namespace pbf::PBF_VARIANT
