#include "lib/program/gauges.h"

#include <algorithm>
#include <cmath>

#include "kernels/boundary/box.h"
#include "kernels/boundary/solid_term.h"
#include "lib/program/loads.h"
#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"

namespace pbf::inline program_module {
namespace {

constexpr int kPerH = 8;  ///< sample points of a level gauge per h

/// From SI units and the scene's axes to the internal frame.
class Frame {
 public:
  Frame(const Scene& s, const Axes& axes) : s_(s), axes_(axes) {}
  void place(const Double3& x, double (&to)[3]) const {
    const Double3 o = s_.origin();
    for (int k = 0; k < 3; ++k) {
      const auto a = std::size_t(axes_.of[k]);
      to[k] = s_.dimensions == 2 && a == 1 ? 0 : (x[a] - o[a]) / s_.h();
    }
  }
  void direction(const Double3& v, double (&to)[3]) const {
    for (int k = 0; k < 3; ++k) to[k] = v[std::size_t(axes_.of[k])];
  }

 private:
  const Scene& s_;
  const Axes& axes_;
};

/// The walls with scale and range 1, so that term() gives the share of the kernel behind them.
Box<double> whole_kernel_walls(const Scene& s, const Axes& axes) {
  Box<double> box;
  double extent[3];
  box.walls = 0;
  for (int k = 0; k < 3; ++k) {
    const int a = axes.of[k];
    extent[k] = (s.domain.max[std::size_t(a)] - s.domain.min[std::size_t(a)]) / s.h();
    if (s.dimensions == 2 && a == 1) continue;
    for (const int high : {0, 1})
      if (!s.domain.is_open(a, high == 1)) box.walls |= 1u << (2 * k + high);
  }
  box.extent = {extent[0], extent[1], extent[2]};
  return box;
}

template <int D>
LevelLine level_line(const Probe& p, const Box<double>& walls,
                     const std::vector<Solid<double>>& solids) {
  constexpr Smoothing poly6 = D == 2 ? Smoothing::paper_2d : Smoothing::paper;
  const auto at = [&](double n) {
    double x[3] = {p.from[0], p.from[1], p.from[2]};
    x[p.axis] += n * p.step;
    return Vec3<double>{x[0], x[1], x[2]};
  };
  const auto free = [&](double n) {
    return std::none_of(solids.begin(), solids.end(),
                        [&](const Solid<double>& o) { return distance<D>(o, at(n)) < 0; });
  };
  LevelLine line;
  for (int n = 0; n < p.count; ++n) {
    double share = 0;
    for (const Solid<double>& o : solids) share += solid_term<poly6>(o, at(n), 1.0).share;
    line.room.push_back((1 - walls.term<poly6>(at(n)).density) * std::max(1 - share, 0.0));
  }
  for (int n = 0; n + 1 < p.count; ++n) {
    const bool here = free(n), there = free(n + 1);
    LevelPiece piece;
    if (!here && !there) piece.to = 0;
    if (here != there) {
      double a = 0, b = 1;  // the surface lies between
      for (int k = 0; k < 40; ++k) (free(n + (a + b) / 2) == here ? a : b) = (a + b) / 2;
      (here ? piece.to : piece.from) = a;
    }
    line.pieces.push_back(piece);
  }
  return line;
}

Probe level_probe(const Gauge& g, const Scene& s, const Axes& axes, const Frame& frame) {
  Probe p;
  Double3 from = s.domain.min;
  const std::vector<int> across = axes_across_level(s);
  for (std::size_t k = 0; k < across.size(); ++k) from[std::size_t(across[k])] = g.at[k];
  frame.place(from, p.from);
  p.axis = axes.inside(level_axis(s));
  const auto a = std::size_t(level_axis(s));
  const double length = (s.domain.max[a] - s.domain.min[a]) / s.h();
  const int pieces = int(std::min(std::ceil(length * kPerH), 1e6));
  p.step = length / pieces;
  p.count = pieces + 1;
  return p;
}

FlowGate flow_gate(const Gauge& g, const Scene& s, const Frame& frame) {
  FlowGate gate;
  const Double3 n = unit(g.normal);
  // The first edge is horizontal (perpendicular to z); for a normal along z it is along x.
  const double level = std::hypot(n[0], n[1]);
  const Double3 first = s.dimensions == 2 ? Double3{-n[2], 0, n[0]}
                        : level > 1e-9    ? unit({-n[1], n[0], 0})
                                          : Double3{1, 0, 0};
  frame.direction(n, gate.normal);
  frame.direction(first, gate.edge[0]);
  frame.direction(cross(n, first), gate.edge[1]);
  double center[3];
  frame.place(g.center, center);
  const auto along = [&](const double(&v)[3]) {
    return v[0] * center[0] + v[1] * center[1] + v[2] * center[2];
  };
  gate.middle[0] = along(gate.normal);
  gate.middle[1] = along(gate.edge[0]), gate.middle[2] = along(gate.edge[1]);
  for (std::size_t e = 0; e < 2; ++e) {
    const double edge = e < g.size.size() ? g.size[e] / s.h() : 1e9;
    gate.half[e] = edge / 2 + 1e-5 * (1 + edge);  // particles on a wall, rounded
  }
  return gate;
}

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
  const std::size_t faces = kFaceNames.size();
  const Obstacle* o = std::size_t(surface) < faces ? nullptr : &s.obstacles[surface - faces];
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

Patch patch_of(const Gauge& g, int surface, const SurfacePlace& there, const Scene& s,
               const Axes& axes, const Frame& frame) {
  Patch p;
  const int faces = int(kFaceNames.size());
  p.wall = surface < faces ? 2 * axes.inside(surface / 2) + surface % 2 : surface;
  frame.place(there.point, p.center);
  frame.direction(there.normal, p.normal);
  p.radius = g.radius / s.h();
  p.soft = s.fluid.spacing / s.h();
  if (surface < faces) return p;
  const Obstacle& o = s.obstacles[std::size_t(surface - faces)];
  if (const RoundSide<double> side = round_side(o, s, there.point); side.radius > 0) {
    p.bend = side.radius / s.h();
    frame.place(o.middle(), p.middle);
    if (side.high > side.low) frame.direction(o.axes()[2], p.axis);
    p.low = side.low / s.h(), p.high = side.high / s.h();
  }
  return p;
}

}  // namespace

GaugePlan plan_gauges(const Scene& s, const Axes& axes, const std::vector<Solid<double>>& solids,
                      double mass) {
  GaugePlan plan;
  const Frame frame(s, axes);
  const Box<double> walls = whole_kernel_walls(s, axes);
  const bool flat = s.dimensions == 2;
  const double h = s.h(), third = flat ? s.domain.max[1] - s.domain.min[1] : h;
  plan.weight = mass / (s.fluid.rest_density * h * h * third) *
                (flat ? Poly6<double, 2>::norm : Poly6<double>::norm) / double(kProbeUnits);
  for (const Gauge& g : s.gauges) {
    const Double3 at = g.at.size() == 3 ? Double3{g.at[0], g.at[1], g.at[2]} : Double3{};
    if (g.kind == GaugeKind::level || g.kind == GaugeKind::velocity) {
      Probe p;
      if (g.kind == GaugeKind::level) {
        p = level_probe(g, s, axes, frame);
        plan.lines.push_back(flat ? level_line<2>(p, walls, solids)
                                  : level_line<3>(p, walls, solids));
      } else {
        frame.place(at, p.from);
        p.moving = true;
      }
      p.first = plan.places;
      plan.places += p.count;
      plan.probes.push_back(p);
    } else if (g.kind == GaugeKind::flow) {
      plan.gates.push_back(flow_gate(g, s, frame));
    } else {
      const int surface = *surface_named(s, g.on);
      const SurfacePlace there = nearest_place_on(surface, s, at);
      plan.patches.push_back(patch_of(g, surface, there, s, axes, frame));
      plan.patches.back().row = int(first_gauge_row(s)) + int(plan.areas.size());
      plan.areas.push_back(wetted_area(plan.patches.back(), surface, there, s));
    }
  }
  return plan;
}

}  // namespace pbf::inline program_module
