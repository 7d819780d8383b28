#include "lib/solver/gauge_readings.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/scene/surface.h"

namespace pbf::inline solver_module {
namespace {

std::string text(const Double3& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

std::string place_of(const Gauge& g, const Scene& s) {
  const auto at = [&] { return text({g.at[0], g.at[1], g.at[2]}); };
  std::string out;
  switch (g.kind) {
    case GaugeKind::level: {
      const std::vector<int> across = axes_across_level(s);
      for (std::size_t k = 0; k < across.size(); ++k)
        out +=
            fmt::format("{}{} = {:.6g} m", out.empty() ? "" : ", ", char('x' + across[k]), g.at[k]);
      return out;
    }
    case GaugeKind::velocity:
      return at() + " m";
    case GaugeKind::flow: {
      for (const double e : g.size) out += fmt::format("{}{:.6g}", out.empty() ? "" : " x ", e);
      return text(g.center) + " m, normal " + text(g.normal) + ", " + out + " m";
    }
    case GaugeKind::pressure:
      return g.on + " at " + at() + fmt::format(" m, radius {:.6g} m", g.radius);
  }
  return out;
}

/// The fraction of a piece that is wet and outside of obstacles. `a`, `b`: at its two ends, fluid
/// fraction minus half of the free space; linear between them, wet where positive. So the surface
/// is where fluid fills half of the free space, also beside walls.
double wet_part(double a, double b, const LevelPiece& free) {
  double from = 0, to = 1;
  if (!(a > 0) && !(b > 0)) return 0;
  if (!(a > 0)) from = a / (a - b);
  if (!(b > 0)) to = a / (a - b);
  return std::max(std::min(to, free.to) - std::max(from, free.from), 0.0);
}

double level(const Probe& p, const LevelLine& line, const GaugePlan& plan,
             const std::vector<ProbeSums>& sums) {
  const auto above = [&](std::size_t n) {
    return plan.weight * double(sums[std::size_t(p.first) + n].weight) - 0.5 * line.room[n];
  };
  double wet = 0, here = above(0);
  for (std::size_t n = 0; n < line.pieces.size(); ++n) {
    const double next = above(n + 1);
    wet += wet_part(here, next, line.pieces[n]);
    here = next;
  }
  return wet * p.step;
}

}  // namespace

std::vector<GaugeData> gauge_data(const Scene& scene) {
  std::vector<GaugeData> all;
  for (const Gauge& g : scene.gauges) {
    GaugeData d{g.name, kGaugeKinds[std::size_t(g.kind)], place_of(g, scene)};
    switch (g.kind) {
      case GaugeKind::level:
        break;
      case GaugeKind::velocity:
        d.unit = "m/s", d.components = 3;
        break;
      case GaugeKind::flow:
        d.unit = "kg/s", d.further = "total", d.further_unit = "kg";
        break;
      case GaugeKind::pressure:
        d.unit = "Pa", d.further = "peak", d.further_unit = "Pa";
        break;
    }
    all.push_back(std::move(d));
  }
  return all;
}

std::vector<double> gauge_readings(const GaugeSums& sums, const Scene& scene, const Plan& plan) {
  const GaugePlan& g = plan.gauges;
  const double h = scene.h();
  std::size_t probe = 0, line = 0, flow = 0, patch = 0;
  std::vector<double> out;
  for (const Gauge& gauge : scene.gauges) switch (gauge.kind) {
      case GaugeKind::level:
        out.push_back(h * level(g.probes[probe++], g.lines[line++], g, sums.places));
        break;
      case GaugeKind::velocity: {
        const ProbeSums& s = sums.places[std::size_t(g.probes[probe++].first)];
        Double3 v;
        v.fill(std::numeric_limits<double>::quiet_NaN());
        for (std::size_t k = 0; k < 3 && double(s.weight) / double(kProbeUnits) > 1e-6; ++k)
          v[std::size_t(plan.axes.of[k])] =
              h / scene.time.step * double(s.way[k]) / double(s.weight);
        out.insert(out.end(), v.begin(), v.end());
        break;
      }
      case GaugeKind::flow: {
        const FlowCount& c = sums.flows[flow++];
        out.push_back(c.time > 0 ? plan.mass * double(c.since) / c.time : 0);
        out.push_back(plan.mass * double(c.total));
        break;
      }
      case GaugeKind::pressure: {
        const Load& l = sums.patches[patch];
        const double over = plan.mass * h / g.areas[patch++];
        out.push_back(l.time > 0 ? over * l.impulse[0] / l.time : 0);
        out.push_back(over * l.peak);
        break;
      }
    }
  return out;
}

}  // namespace pbf::inline solver_module
