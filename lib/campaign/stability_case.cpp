#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/stage_clock.h"
#include "lib/campaign/stability.h"
#include "lib/run/linked_files.h"
#include "lib/scene/auto_step.h"
#include "lib/scene/load.h"
#include "lib/scene/overrides.h"

namespace pbf::campaign_module {
namespace {

Scene scene_of(const StabilityCase& c, const StabilityOptions& o, const std::string& dir) {
  Node root = load_scene_tree(c.scene, o.base_folder);
  Problems problems;
  for (const auto& [path, value] : c.set) set_value(root, path, value, problems);
  if (o.reduced)
    for (const auto& [path, value] : c.small) set_value(root, path, value, problems);
  for (const std::string& argument : o.overrides) apply_override(root, argument, problems);
  bool auto_step = false;
  Scene s = scene_of_tree(root, problems, &auto_step);
  problems.raise();
  read_linked_files(s, dir, auto_step);
  if (c.must.loads) {
    s.domain.loads = true;
    for (Obstacle& obstacle : s.obstacles) obstacle.loads = true;
  }
  without_files(s, o);
  return s;
}

std::string number(double v) { return fmt::format("{:.3g}", v); }

/// "speed <= 5 m/s, energy <= 3 %": the requirements of the row, for users.
std::string must_text(const Criteria& m) {
  if (m.error) return fmt::format("error {}", *m.error) + (m.says.empty() ? "" : ": " + m.says);
  if (!m.guard.empty() && m.guard != "allowed") return "guard: " + m.guard;
  std::string out = "finite, inside";
  const auto add = [&out](const char* what, double limit) { out += what + number(limit); };
  if (m.speed) add(", speed<=", *m.speed);
  add(", E<=", m.energy);
  if (m.compression_mean) add(", c<=", *m.compression_mean);
  if (m.compression_max) add(", cmax<=", *m.compression_max);
  if (m.nearest) add(", near>=", *m.nearest);
  if (m.still) add(", Ekin<=", *m.still);
  if (m.height) add(", height>=-", *m.height);
  if (m.momentum) add(", momentum<=", *m.momentum);
  if (m.penetration) add(", in solids<=", *m.penetration);
  if (m.through) add(", through<=", *m.through);
  if (m.loads) add(", loads<=", *m.loads);
  if (!m.warns.empty()) out += ", warns: " + m.warns;
  if (!m.like.empty()) out += ", like " + m.like;
  if (m.guard == "allowed") out += "; or guard";
  return out;
}

/// Relative loss of height of the center of mass above the floor, along gravity.
double height_lost(const Course& c, const Scene& s) {
  const double after = energy_of_height(c.last, s, 1);
  const double before = energy_of_height(c.first, s, 1);
  return before > 0 ? 1 - after / before : 0;
}

double momentum_drift(const Course& c, double mass) {
  double drift = 0;
  for (int a = 0; a < 3; ++a) drift += std::pow(c.last.momentum[a] - c.first.momentum[a], 2);
  // sqrt(2 M E): the sum of the particles' momenta (in magnitude) if all have the same speed.
  const double all = std::sqrt(2 * mass * std::max(c.first.kinetic_energy, c.last.kinetic_energy));
  return all > 0 ? std::sqrt(drift) / all : 0;
}

/// |sum of loads - (M g - dP/dt)| / (M |g|), as means over the run; 0 if only walls and obstacles
/// act on the fluid. Not valid with tank_motion, damping, a speed limit or confinement.
double load_imbalance(const Course& c, const Scene& s, double mass) {
  double off = 0, weight = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    // Gravity has acted until the time of the last velocities.
    const double given = mass * s.gravity[a] * (c.last.time - c.last.velocity_lag);
    const double change = c.last.momentum[a] - c.first.momentum[a];
    off += std::pow((c.impulse[a] - given + change) / c.last.time, 2);
    weight += std::pow(mass * s.gravity[a], 2);
  }
  return std::sqrt(off / weight);
}

void judge(StabilityRow& row, const Criteria& m, const Course& c, const Scene& s) {
  const auto at_most = [&](const char* name, double value, double limit) {
    row.checks.push_back({name, value, limit, value <= limit});
  };
  at_most("lost", double(c.last.non_finite + c.last.outside), 0);
  if (m.speed) at_most("speed", c.speed_max, *m.speed);
  at_most("E", c.energy_rise, m.energy + c.released);
  if (m.compression_mean) at_most("c", c.compression_mean, *m.compression_mean);
  if (m.compression_max) at_most("cmax", c.compression_max, *m.compression_max);
  if (m.nearest) row.checks.push_back({"near", row.nearest, *m.nearest, row.nearest >= *m.nearest});
  if (m.still) at_most("Ekin", c.last.kinetic_energy / c.scale, *m.still);
  if (m.height) at_most("height lost", height_lost(c, s), *m.height);
  const double mass = s.particle_mass() * double(c.particles);
  if (m.momentum) at_most("momentum", momentum_drift(c, mass), *m.momentum);
  if (m.penetration) at_most("in solids", c.penetration / s.h(), *m.penetration);
  if (m.through) at_most("through", c.through / s.particle_mass(), *m.through);
  if (m.loads) at_most("loads", load_imbalance(c, s, mass), *m.loads);
  for (const StabilityCheck& check : row.checks) {
    const bool least = check.name == std::string("near");
    if (check.limit > 0 && (least || check.value > 0)) {
      const double used = least ? check.limit / check.value : check.value / check.limit;
      if (used > row.used) row.used = used, row.tightest = check.name;
    }
    row.happened += (row.happened.empty() ? "" : ", ") + check.name + " " + number(check.value);
    if (check.name == "E" && c.released > 0.01) row.happened += " of " + number(check.limit);
    if (!check.good) row.happened += " (!)";
    row.good = row.good && check.good;
  }
  if (c.steps)
    row.happened +=
        fmt::format(", {} changes of the step, {} times back", c.steps->changes, c.steps->repeats);
}

/// Returns false if o.stop() ended the run.
bool run(StabilityRow& row, const StabilityCase& c, const StabilityOptions& o) {
  const std::string dir = std::filesystem::path(c.scene).parent_path().string();
  const Scene s = scene_of(c, o, dir);
  row.dt_hat = relative_step(s);
  const auto nearest = [&](Solver& solver) {
    const Snapshot snap = solver.download({}, ScalarType::f64).get();
    const auto x = snap.fields[0].as<double>();
    row.nearest = nearest_distance({x.begin(), x.end()}) / s.fluid.spacing;
  };
  // What other cases hold at this time is no property of this one: none is refused for it.
  Start start = prepare(s, dir, {.fits = false, .warnings = !c.must.warns.empty()});
  const bool warned = std::ranges::any_of(start.warnings, [&](const Warning& w) {
    return w.text.find(c.must.warns) != std::string::npos;
  });
  const std::optional<Course> ran = run_course(std::move(start), o.stop, nearest);
  if (!ran) return false;
  const Course& course = *ran;
  static_cast<Figures&>(row) = course;
  row.fast = course.last.fast;
  for (std::size_t a = 0; a < 3; ++a)
    row.center[a] = (course.last.center_of_mass[a] - s.domain.min[a]) / s.h();
  const bool must_stop = !c.must.guard.empty() && c.must.guard != "allowed";
  if (course.event) {
    const std::string alarm = kAlarmNames[static_cast<int>(course.event->alarm)];
    row.happened = "guard: " + alarm + ", " + course.guard_text;
    row.good = c.must.guard == "allowed" || c.must.guard == alarm;
    return true;
  }
  row.good = !must_stop && !c.must.error;
  judge(row, c.must, course, s);
  if (warned || c.must.warns.empty()) return true;
  row.happened += ", no such warning (!)";
  row.good = false;
  return true;
}

}  // namespace

void without_files(Scene& s, const StabilityOptions& o) {
  s.output.reset();
  s.render.reset();
  s.backend = o.backend;
  s.precision = o.precision;
  s.threads = o.threads;
}

std::optional<StabilityRow> run_stability_case(const StabilityCase& c, const StabilityOptions& o) {
  StabilityRow row;
  row.name = c.name;
  row.group = c.group;
  row.must = must_text(c.must);
  const Stopwatch watch;
  try {
    if (!run(row, c, o)) return std::nullopt;
  } catch (const Error& e) {
    if (e.code() == ExitCode::unavailable && !c.must.error) throw;
    row.happened = fmt::format("error {}: {}", static_cast<int>(e.code()), e.what());
    row.good = c.must.error == static_cast<int>(e.code()) &&
               row.happened.find(c.must.says) != std::string::npos;
  }
  row.seconds = watch.seconds();
  return row;
}

void judge_likeness(const std::vector<StabilityCase>& cases, std::vector<StabilityRow>& rows) {
  for (StabilityRow& row : rows) {
    const auto own = std::ranges::find(cases, row.name, &StabilityCase::name);
    if (own == cases.end() || own->must.like.empty()) continue;
    const std::string& like = own->must.like;
    const auto other = std::ranges::find(rows, like, &StabilityRow::name);
    if (other == rows.end()) {
      row.happened += ", " + like + " was not run";
      continue;
    }
    double distance = 0;
    for (std::size_t a = 0; a < 3; ++a)
      distance = std::max(distance, std::fabs(row.center[a] - other->center[a]));
    const bool good = distance <= kLikeness;
    row.checks.push_back({"like", distance, kLikeness, good});
    row.happened += ", like " + number(distance) + " h" + (good ? "" : " (!)");
    row.good = row.good && good;
  }
}

}  // namespace pbf::campaign_module
