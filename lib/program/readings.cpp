#include <algorithm>
#include <cmath>

#include "lib/program/column.h"
#include "lib/program/dissipation.h"
#include "lib/program/loads.h"
#include "lib/program/motion.h"
#include "lib/program/plan.h"

namespace pbf::program_module {

double load_grain(const Scene& s, const Plan& plan) {
  const double dt = s.time.step / plan.substeps;
  const double bookings =
      double(plan.particles) * (1 + 3 * s.solver.iterations * (1 + plan.repeats));
  return plan.mass * s.h() / (dt * dt) * bookings / double(kLoadUnits);
}

std::vector<ReadingColumn> reading_columns(const Scene& s, const Plan& plan) {
  using enum Join;
  using enum Series;
  std::vector<ReadingColumn> all;
  const double grain = load_grain(s, plan);
  double arm = 0;  // m; torques are about the domain's corner, in units of up to twice its edges
  for (std::size_t k = 0; k < 3; ++k) arm = std::hypot(arm, s.domain.max[k] - s.domain.min[k]);
  for (const std::string& of : loaded_names(s)) {
    const std::vector<ReadingColumn> columns = load_columns(of, grain, arm);
    all.insert(all.end(), columns.begin(), columns.end());
  }
  for (const Dissipation by : dissipations(s)) {
    const double unit = dissipation_unit(s, plan);
    all.push_back({"dissipation",
                   kDissipationNames[std::size_t(by)],
                   "energy",
                   "J",
                   "",
                   total,
                   1,
                   measures,
                   {unit * double(plan.particles)}});
  }
  for (std::size_t e = 0; e < s.emitters.size(); ++e) {
    const std::string& of = s.emitters[e].name;
    const auto layer = double(plan.emission.nozzles[e].columns);
    all.push_back({"emitter", of, "particles", "1", "", total, 1, measures, {layer}});
    all.push_back({"emitter", of, "mass", "kg", "", total, 1, measures, {layer * plan.mass}});
    all.push_back({"emitter", of, "energy", "J", "", total, 1, measures});
  }
  for (const Sink& k : s.sinks) {
    all.push_back({"sink", k.name, "particles", "1", "", total, 1, measures, {1}});
    all.push_back({"sink", k.name, "mass", "kg", "", total, 1, measures, {plan.mass}});
    all.push_back({"sink", k.name, "momentum", "kg m/s", "", total, 3, measures});
    all.push_back({"sink", k.name, "energy", "J", "", total, 1, measures});
  }
  all.insert(all.end(), plan.gauges.columns.begin(), plan.gauges.columns.end());
  for (const Obstacle& o : s.obstacles) {
    if (!o.moves()) continue;
    const std::vector<ReadingColumn> of = body_columns(o.name);
    all.insert(all.end(), of.begin(), o.free ? of.end() : of.begin() + 2);
  }
  return all;
}

std::vector<ReadingColumn> load_columns(const std::string& of, double grain, double arm) {
  using enum Join;
  constexpr Series kWhen = Series::measures;
  return {{"load", of, "force", "N", "", mean, 3, kWhen, {grain}, 1},
          {"load", of, "torque", "N m", "", mean, 3, kWhen, {3 * arm * grain}, arm},
          {"load", of, "force_peak", "N", "", peak, 1, kWhen, {grain}, 1},
          {"load", of, "impulse", "N s", "", total, 3, kWhen, {grain}, 1}};
}

std::vector<std::string> loaded_names(const Scene& s) {
  std::vector<std::string> names;
  for (const int surface : loaded_surfaces(s)) {
    const Obstacle* o = obstacle_of(s, surface);
    names.push_back(o ? o->name : kFaceNames[std::size_t(surface)]);
  }
  return names;
}

std::vector<ReadingColumn> body_columns(const std::string& name) {
  const auto column = [&](const char* what, const char* unit, int components) {
    return ReadingColumn{"pose", name, what, unit, "", Join::now, components, Series::poses};
  };
  return {column("", "m", 3), column("turn", "1", 9), column("velocity", "m/s", 3),
          column("spin", "rad/s", 3)};
}

std::vector<double> pose_readings(const Scene& s, double time,
                                  const std::vector<BodyMotion>& bodies) {
  std::vector<double> out;
  auto body = bodies.begin();
  for (const Obstacle& o : s.obstacles) {
    if (o.free) BodyMotion::each(*body++, [&](double x) { out.push_back(x); });
    if (!o.motion) continue;
    const Pose pose = pose_of(s, o, time);
    const Double3 middle = pose.of(o.middle());
    out.insert(out.end(), middle.begin(), middle.end());
    for (const Double3& row : pose.turn) out.insert(out.end(), row.begin(), row.end());
  }
  return out;
}

std::string number_name(const ReadingColumn& column, int component) {
  std::string name = column.name;
  if (column.components == 1) return name;
  if (!name.empty()) name += '_';
  if (column.components == 9) name += "xyz"[component / 3];
  return name += "xyz"[component % 3];
}

std::vector<double> load_readings(const std::vector<Load>& loads, const Scene& s,
                                  const Plan& plan) {
  std::vector<double> out;
  const auto& of = plan.axes.of;
  const double hand = plan.axes.handedness(), h = s.h();
  for (const int surface : loaded_surfaces(s)) {
    const Load& load = loads[std::size_t(load_row(surface, plan.axes))];
    double middle[3] = {0, 0, 0};  // the moment of a moving obstacle is already about its middle
    if (const Obstacle* o = obstacle_of(s, surface); !o)
      for (int k = 0; k < 3; ++k) {
        const auto a = std::size_t(of[k]);
        const double extent = (s.domain.max[a] - s.domain.min[a]) / h;
        middle[k] = of[k] != surface / 2 ? extent / 2 : surface % 2 ? extent : 0;
      }
    else if (!o->moves()) {
      const Vec3<double>& c = plan.solids[std::size_t(o - s.obstacles.data())].center;
      middle[0] = c.x, middle[1] = c.y, middle[2] = c.z;
    }
    double force[3], torque[3];
    const double unit = load.time > 0 ? plan.mass * h / load.time : 0;
    for (int k = 0; k < 3; ++k) {
      const int b = (k + 1) % 3, c = (k + 2) % 3;
      force[of[k]] = unit * load.impulse[k];
      // A cross product changes its sign if the axes have the other handedness.
      torque[of[k]] = hand * unit * h *
                      (load.moment[k] - middle[b] * load.impulse[c] + middle[c] * load.impulse[b]);
    }
    out.insert(out.end(), force, force + 3);
    out.insert(out.end(), torque, torque + 3);
    out.push_back(plan.mass * h * load.peak);
    double total[3];
    for (int k = 0; k < 3; ++k) total[of[k]] = plan.mass * h * load.total[k];
    out.insert(out.end(), total, total + 3);
  }
  return out;
}

}  // namespace pbf::program_module
