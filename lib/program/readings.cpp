#include <algorithm>
#include <cmath>

#include "lib/program/column.h"
#include "lib/program/loads.h"
#include "lib/program/motion.h"
#include "lib/program/plan.h"

namespace pbf::inline program_module {
namespace {

/// The surfaces (surface_named()) whose loads are read.
std::vector<int> loaded_surfaces(const Scene& s) {
  std::vector<int> all;
  for (int face = 0; s.domain.loads && face < int(kFaceNames.size()); ++face)
    if (!s.domain.is_open(face / 2, face % 2 == 1) && !(s.dimensions == 2 && face / 2 == 1))
      all.push_back(face);
  for (std::size_t k = 0; k < s.obstacles.size(); ++k)
    if (s.obstacles[k].loads) all.push_back(int(kFaceNames.size() + k));
  return all;
}

void add_load_columns(const Scene& s, const Plan& plan, std::vector<ReadingColumn>& to) {
  double arm =
      0;  // m; torques are about the domain's corner, in units of up to twice its longest edge
  for (std::size_t k = 0; k < 3; ++k) arm = std::hypot(arm, s.domain.max[k] - s.domain.min[k]);
  const double grain = load_grain(s, plan);
  for (const int surface : loaded_surfaces(s)) {
    const auto add = [&](const char* name, const char* unit, Join join, int components,
                         double of_force, double lever) {
      to.push_back({"load",
                    surface_name(s, surface),
                    name,
                    unit,
                    "",
                    join,
                    components,
                    Series::measures,
                    {of_force * grain},
                    lever});
    };
    add(kForce.data(), "N", Join::mean, 3, 1, 1);
    add("torque", "N m", Join::mean, 3, 3 * arm, arm);
    add("force_peak", "N", Join::peak, 1, 1, 1);
  }
}

void add_gauge_columns(const Scene& s, const GaugePlan& plan, std::vector<ReadingColumn>& to) {
  for (std::size_t k = 0; k < s.gauges.size(); ++k)
    std::visit(
        [&]<class Kind>(const Kind& gauge) {
          using Keys = typename Kind::Keys;
          const std::string place = Kind::place(std::get<Keys>(s.gauges[k].kind), s);
          for (std::size_t c = 0; c < Keys::columns.size(); ++c) {
            const GaugeColumn& is = Keys::columns[c];
            to.push_back({Keys::word, s.gauges[k].name, is.name, is.unit, place, is.join,
                          is.components, Series::gauges, gauge.grains[c]});
          }
        },
        plan.all[k]);
}

}  // namespace

double load_grain(const Scene& s, const Plan& plan) {
  const double dt = s.time.step / plan.substeps;
  const double bookings =
      double(plan.particles) * (1 + 3 * s.solver.iterations * (1 + plan.repeats));
  return plan.mass * s.h() / (dt * dt) * bookings / double(kLoadUnits);
}

std::vector<ReadingColumn> reading_columns(const Scene& scene, const Plan& plan) {
  std::vector<ReadingColumn> all;
  add_load_columns(scene, plan, all);
  add_gauge_columns(scene, plan.gauges, all);
  for (const Obstacle& o : scene.obstacles) {
    if (!o.motion) continue;
    all.push_back({"pose", o.name, "", "m", "", Join::now, 3, Series::poses});
    all.push_back({"pose", o.name, "turn", "1", "", Join::now, 9, Series::poses});
  }
  return all;
}

std::vector<double> pose_readings(const Scene& s, double time) {
  std::vector<double> out;
  for (const Obstacle& o : s.obstacles) {
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
    else if (!o->motion) {
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
  }
  return out;
}

}  // namespace pbf::inline program_module
