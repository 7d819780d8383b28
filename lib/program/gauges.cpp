#include "lib/program/gauges.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/program/level_line.h"
#include "lib/program/loads.h"
#include "lib/program/plan.h"
#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"

namespace pbf::program_module {
namespace {

/// What gauges are made from besides their keys.
struct Frame {
  const Scene& s;
  const Plan& plan;
  int first = 0;  ///< number of the gauge's first sum among those of its tally

  /// In the internal frame.
  void place(const Double3& x, double (&to)[3]) const { put(to, internal_place(s, plan.axes, x)); }
  void direction(const Double3& v, double (&to)[3]) const { put(to, along_internal(plan.axes, v)); }
  /// Bound on the number of particles within a radius (m) of a point: those in a cube around it.
  double particles_around(double radius) const {
    return std::pow(2 * radius / s.fluid.spacing, s.dimensions);
  }
};

/// What a kind makes of the keys of a gauge.
template <class Tally>
struct PlannedGauge {
  typename Tally::Site site{};
  int sums = 1;                 ///< number of its sums
  std::string place{};          ///< for readers of the run file
  std::vector<Grain> grains{};  ///< of its columns
  /// The numbers of a reading from its sums, in SI units, column by column.
  std::function<std::vector<double>(const typename Tally::Sums*)> finish{};
};

/// x: three numbers.
std::string text(const auto& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

constexpr int kPerH = 8;  ///< sample points of a line per h

/// The gauge of a line whose probe has its place and direction. length: h. connected: up to the
/// first gap; from the far end, if backward.
void finish_line(PlannedGauge<ProbeTally>& gauge, const Frame& frame, double length, bool connected,
                 bool backward) {
  const Scene& s = frame.s;
  const bool flat = s.dimensions == 2;
  Probe& p = gauge.site;
  const int pieces = int(std::min(std::ceil(length * kPerH), 1e6));
  p.step = length / pieces;
  p.count = gauge.sums = pieces + 1;
  p.first = frame.first;
  const Box<double> walls = whole_kernel_walls(s, frame.plan.axes);
  const double h = s.h(), third = flat ? s.domain.max[1] - s.domain.min[1] : h;
  // ProbeSums::weight times this is the volume fraction of fluid.
  const double weight = frame.plan.mass / (s.fluid.rest_density * h * h * third) *
                        (flat ? Poly6<double, 2>::norm : Poly6<double>::norm) / double(kProbeUnits);
  gauge.grains = {{h * weight * frame.particles_around(h)}};
  gauge.finish = [line = flat ? level_line<2>(p, walls, frame.plan.solids)
                              : level_line<3>(p, walls, frame.plan.solids),
                  h, weight, connected, backward, step = p.step,
                  gap = s.fluid.spacing / (h * p.step)](const ProbeSums* sums) {
    const auto above = [&](std::size_t n) {
      return weight * double(sums[n].weight) - 0.5 * line.free_share[n];
    };
    const double wet =
        connected ? connected_length(line, above, gap, backward) : wet_length(line, above);
    return std::vector<double>{h * (wet * step)};
  };
}

PlannedGauge<ProbeTally> planned(const gauge_keys::Level& g, const Frame& frame) {
  PlannedGauge<ProbeTally> gauge;
  const Scene& s = frame.s;
  Double3 from = s.domain.min;
  const std::vector<int> across = axes_across_level(s);
  for (std::size_t k = 0; k < across.size(); ++k) {
    from[std::size_t(across[k])] = g.at[k];
    gauge.place += fmt::format("{}{} = {:.6g} m", k ? ", " : "", "xyz"[across[k]], g.at[k]);
  }
  frame.place(from, gauge.site.from);
  gauge.site.axis = frame.plan.axes.inside(level_axis(s));
  const auto a = std::size_t(level_axis(s));
  finish_line(gauge, frame, (s.domain.max[a] - s.domain.min[a]) / s.h(), g.connected,
              s.gravity[a] > 0);
  return gauge;
}

PlannedGauge<ProbeTally> planned(const gauge_keys::Line& g, const Frame& frame) {
  const Scene& s = frame.s;
  Double3 from = g.from, to = g.to;
  if (s.dimensions == 2) from[1] = to[1] = *s.plane();
  PlannedGauge<ProbeTally> gauge{.place = text(from) + " to " + text(to) + " m"};
  frame.place(from, gauge.site.from);
  frame.direction(unit(to - from), gauge.site.direction);
  gauge.site.axis = Probe::inclined;
  finish_line(gauge, frame, std::sqrt(dot(to - from, to - from)) / s.h(), g.connected, false);
  return gauge;
}

PlannedGauge<ProbeTally> planned(const gauge_keys::Velocity& g, const Frame& frame) {
  PlannedGauge<ProbeTally> gauge{.place = text(g.at) + " m"};
  frame.place({g.at[0], g.at[1], g.at[2]}, gauge.site.from);
  gauge.site.moving = true;
  gauge.site.first = frame.first;
  const double within = g.within.value_or(frame.s.h());
  gauge.site.scale = frame.s.h() / within;
  const double unit = frame.s.h() / frame.s.time.step;  // m/s, of h per update
  gauge.grains = {{unit * frame.particles_around(within) / double(kProbeUnits)}};
  gauge.finish = [unit, axes = frame.plan.axes](const ProbeSums* s) -> std::vector<double> {
    const double weight = double(s->weight);
    if (!(weight / double(kProbeUnits) > 1e-6))
      return std::vector<double>(3, std::numeric_limits<double>::quiet_NaN());
    const auto along = [&](int k) { return unit * double(s->way[k]) / weight; };
    const Double3 v = along_scene(axes, {along(0), along(1), along(2)});
    return {v.begin(), v.end()};
  };
  return gauge;
}

PlannedGauge<FlowTally> planned(const gauge_keys::Flow& g, const Frame& frame) {
  PlannedGauge<FlowTally> gauge;
  const Scene& s = frame.s;
  FlowGate& gate = gauge.site;
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
  std::string size;
  for (const double e : g.size) size += fmt::format("{}{:.6g}", size.empty() ? "" : " x ", e);
  gauge.place = text(g.center) + " m, normal " + text(g.normal) + ", " + size + " m";
  gauge.grains = {{0, frame.plan.mass}, {frame.plan.mass}};
  gauge.finish = [mass = frame.plan.mass](const FlowCount* c) -> std::vector<double> {
    return {c->time > 0 ? mass * double(c->since) / c->time : 0, mass * double(c->total)};
  };
  return gauge;
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

PlannedGauge<PatchTally> planned(const gauge_keys::Pressure& g, const Frame& frame) {
  PlannedGauge<PatchTally> gauge;
  const Scene& s = frame.s;
  const int surface = *surface_named(s, g.on);
  const SurfacePlace there = nearest_place_on(surface, s, {g.at[0], g.at[1], g.at[2]});
  Patch& p = gauge.site;
  p.wall = load_row(surface, frame.plan.axes);
  p.row = load_row_of_patch(s, frame.first);
  frame.place(there.point, p.center);
  frame.direction(there.normal, p.normal);
  p.radius = g.radius / s.h();
  p.soft = s.fluid.spacing / s.h();
  if (const Obstacle* o = obstacle_of(s, surface))
    if (const RoundSide<double> side = round_side(*o, s, there.point); side.radius > 0) {
      p.bend = side.radius / s.h();
      frame.place(o->middle(), p.middle);
      if (side.high > side.low) frame.direction(o->axes()[2], p.axis);
      p.low = side.low / s.h(), p.high = side.high / s.h();
    }
  const double area = wetted_area(p, surface, there, s);
  gauge.place = g.on + " at " + text(g.at) + fmt::format(" m, radius {:.6g} m", g.radius);
  const Grain grain{load_grain(s, frame.plan) / area};
  gauge.grains = {grain, grain};
  gauge.finish = [unit = frame.plan.mass * s.h() / area](const Load* l) -> std::vector<double> {
    return {l->time > 0 ? unit * l->impulse[0] / l->time : 0, unit * l->peak};
  };
  return gauge;
}

}  // namespace

GaugePlan plan_gauges(const Scene& scene, const Plan& plan) {
  GaugePlan gauges;
  Frame frame{scene, plan};
  for (const Gauge& g : scene.gauges)
    std::visit(
        [&]<class Keys>(const Keys& keys) {
          using Tally = typename Keys::Tally;
          auto& of = std::get<TalliedGauges<Tally>>(gauges.tallies);
          frame.first = of.sums;
          const PlannedGauge<Tally> gauge = planned(keys, frame);
          of.sites.push_back(gauge.site);
          of.sums += gauge.sums;
          for (std::size_t k = 0; k < Keys::columns.size(); ++k) {
            const GaugeColumn& c = Keys::columns[k];
            gauges.columns.push_back({Keys::word, g.name, c.name, c.unit, gauge.place, c.join,
                                      c.components, Series::gauges, gauge.grains.at(k)});
          }
          gauges.finish_each.push_back(
              [first = frame.first, finish = gauge.finish](const GaugeSums& sums) {
                return finish(std::get<TallySums<Tally>>(sums).rows.data() + first);
              });
        },
        g.kind);
  return gauges;
}

std::vector<double> GaugePlan::finish(const GaugeSums& sums) const {
  std::vector<double> out;
  for (const auto& finish_one : finish_each) {
    const std::vector<double> numbers = finish_one(sums);
    out.insert(out.end(), numbers.begin(), numbers.end());
  }
  return out;
}

}  // namespace pbf::program_module
