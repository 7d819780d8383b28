#include "lib/verify/compare_readings.h"

#include <algorithm>
#include <cmath>

#include "lib/program/loads.h"
#include "lib/solver/gauge_readings.h"

namespace pbf::inline verify_module {
namespace {

/// Bound on the rounding of a force to whole units, N: one unit of displacement for each
/// contribution of a particle to a wall in an update. A particle contributes after the prediction
/// and, per iteration, by the pushes of walls and levels and by the stop at walls.
double force_grain(const Scene& s, const Plan& plan) {
  const double dt = s.time.step / plan.substeps;
  const double bookings =
      double(plan.particles) * (1 + 3 * s.solver.iterations * (1 + plan.repeats));
  return plan.mass * s.h() / (dt * dt) * bookings / double(kLoadUnits);
}

void add_loads(std::vector<Reading>& out, Solver& solver, const Scene& s, const Plan& plan) {
  double arm = 0;  // m
  for (std::size_t k = 0; k < 3; ++k) arm = std::hypot(arm, s.domain.max[k] - s.domain.min[k]);
  const double grain = force_grain(s, plan);
  for (const WallLoad& l : solver.loads(Interval::ends))
    for (const LoadNumber& n : load_numbers()) {
      // Torques are about the domain's corner, in units of up to twice its longest edge.
      const double lever = std::string(n.unit) == "N m" ? arm : 1;
      out.push_back({"loads", "loads: " + l.wall + " " + n.name, n.unit, n.value(l), lever * l.peak,
                     (lever == arm ? 3 * arm : 1) * grain});
    }
}

/// For a gauge's own number, and for the second one of some gauges.
struct Grains {
  double own = 0, further = 0;
};
Grains gauge_grains(const Gauge& g, double area, const Scene& s, const Plan& plan, double time) {
  // Particles within h of a point: at most as in a cube of edge 2 h.
  const double around = std::pow(2 * s.h() / s.fluid.spacing, s.dimensions);
  switch (g.kind) {
    case GaugeKind::level:
      return {s.h() * plan.gauges.weight * around};
    case GaugeKind::velocity:
      return {s.h() / s.time.step * around / double(kProbeUnits)};
    case GaugeKind::flow:
      return {plan.mass / time, plan.mass};
    case GaugeKind::pressure:
      return {force_grain(s, plan) / area, force_grain(s, plan) / area};
  }
  return {};
}

void add_gauges(std::vector<Reading>& out, Solver& solver, const Scene& s, const Plan& plan,
                double time) {
  const std::vector<double> values = solver.gauges(Interval::ends);
  const std::vector<GaugeData> data = gauge_data(s);
  std::size_t at = 0, patch = 0;
  for (std::size_t k = 0; k < data.size(); ++k) {
    const GaugeData& d = data[k];
    const bool pressure = s.gauges[k].kind == GaugeKind::pressure;
    const Grains grains =
        gauge_grains(s.gauges[k], pressure ? plan.gauges.areas[patch++] : 1, s, plan, time);
    double scale = 0;  // length of a vector; peak of a pressure
    for (int c = 0; c < d.numbers() && (d.components == 3 || pressure); ++c)
      scale = std::hypot(scale, values[at + std::size_t(c)]);
    for (int c = 0; c < d.numbers(); ++c) {
      const bool own = c < d.components;
      std::string what = "gauges: " + d.name;
      if (!own)
        what += std::string(" ") + d.further;
      else if (d.components == 3)
        what += std::string(" ") + "xyz"[c];
      out.push_back({"gauges", what, own ? d.unit : d.further_unit, values[at++], scale,
                     own ? grains.own : grains.further});
    }
  }
}

}  // namespace

std::vector<Reading> take_readings(Solver& solver, const Scene& scene, const Plan& plan,
                                   int updates) {
  std::vector<Reading> out;
  add_loads(out, solver, scene, plan);
  add_gauges(out, solver, scene, plan, scene.time.step * updates);
  return out;
}

const Reading* find_reading(const std::vector<Reading>& readings, const std::string& what) {
  const auto r = std::find_if(readings.begin(), readings.end(),
                              [&](const Reading& one) { return one.what == what; });
  return r == readings.end() ? nullptr : &*r;
}

}  // namespace pbf::inline verify_module
