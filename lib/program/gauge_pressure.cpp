#include <algorithm>
#include <cmath>

#include "lib/program/gauges.h"
#include "lib/program/loads.h"
#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"

namespace pbf::inline program_module {
namespace {

/// Where the round side of an obstacle is before its centre or axis, seen from x; also beyond the
/// ends of a cylinder, where there is no surface.
Double3 on_round_side(const Obstacle& o, const RoundSide<double>& side, const Double3& x,
                      bool flat) {
  const Double3 axis = o.axes()[2];
  Double3 foot = o.middle();
  foot = foot + std::clamp(dot(x - foot, axis), side.low, side.high) * axis;
  if (flat) foot[1] = x[1];
  return foot + side.radius * unit(x - foot);
}

/// m^2: the integral of patch_share() over the part of the surface that fluid can touch.
double wetted_area(const Patch& patch, int surface, const SurfacePlace& there, const Scene& s) {
  constexpr int kCells = 400;
  const double h = s.h(), reach = (patch.radius + patch.soft) * h, cell = 2 * reach / kCells;
  const Double3 n = there.normal;
  const Double3 u = unit(s.dimensions == 2       ? Double3{-n[2], 0, n[0]}
                         : std::fabs(n[0]) < 0.7 ? cross(n, {1, 0, 0})
                                                 : cross(n, {0, 1, 0}));
  const Double3 v = cross(n, u);
  const double tiny = 1e-6 * h;
  const Obstacle* o = obstacle_of(s, surface);
  const RoundSide<double> side = o ? round_side(*o, s, there.point) : RoundSide<double>{};
  const bool bent = o && side.radius == 0 && is_bent(*o);
  double sum = 0;
  const int rows = s.dimensions == 2 ? 1 : kCells;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < kCells; ++i) {
      const double a = (i + 0.5) * cell - reach, b = rows == 1 ? 0 : (j + 0.5) * cell - reach;
      const double share = patch_share(patch, (a * a + b * b) / (h * h));
      if (share == 0) continue;
      Double3 x = there.point + a * u + b * v;
      if (side.radius > 0) x = on_round_side(*o, side, x, s.dimensions == 2);
      if (bent) x = nearest_place(*o, s, x).point;
      const SurfacePlace near = nearest_place_on(surface, s, x);
      if (std::fabs(near.distance) > tiny) continue;  // beyond the face
      // Obstacles that stand on the surface cover it.
      if (is_free(s, x, tiny) && is_free(s, x + (1000 * tiny) * near.normal, tiny)) sum += share;
    }
  const double thick = s.domain.max[1] - s.domain.min[1];
  return sum * cell * (rows == 1 ? thick : cell);
}

}  // namespace

namespace gauge_kinds {

Pressure::Pressure(const Keys& keys, const GaugeFrame& frame) {
  const Scene& s = frame.scene;
  const int surface = *surface_named(s, keys.on);
  const SurfacePlace there = nearest_place_on(surface, s, {keys.at[0], keys.at[1], keys.at[2]});
  site.wall = load_row(surface, frame.axes);
  site.row = load_row_of_patch(s, frame.first);
  frame.place(there.point, site.center);
  frame.direction(there.normal, site.normal);
  site.radius = keys.radius / s.h();
  site.soft = s.fluid.spacing / s.h();
  if (const Obstacle* o = obstacle_of(s, surface))
    if (const RoundSide<double> side = round_side(*o, s, there.point); side.radius > 0) {
      site.bend = side.radius / s.h();
      frame.place(o->middle(), site.middle);
      if (side.high > side.low) frame.direction(o->axes()[2], site.axis);
      site.low = side.low / s.h(), site.high = side.high / s.h();
    }
  area = wetted_area(site, surface, there, s);
  unit = frame.mass * s.h() / area;
  grains[0].value = grains[1].value = frame.force_grain / area;
}

}  // namespace gauge_kinds
}  // namespace pbf::inline program_module
