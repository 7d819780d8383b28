// The step of `time.step: auto` in scenes with prescribed motions.
#include <algorithm>
#include <cmath>

#include "lib/base/error.h"
#include "lib/program/motion.h"
#include "lib/run/motion_files.h"
#include "lib/scene/auto_step.h"
#include "lib/scene/validate.h"

namespace pbf::run_module {
namespace {

/// The largest f(from, to) of a motion, over its ramp and one period, or over its table; s since
/// the start.
template <class F>
double largest(const Scene& s, const Swing& swing, bool swings, const MotionTable& table, F&& f) {
  const double begin = s.time.motion_begin;
  if (!table.time.empty()) return f(0.0, std::max(0.0, table.time.back() - begin));
  return swings ? f(0.0, std::max(0.0, swing.ramp - begin) + swing.period) : f(0.0, 0.0);
}

/// The time step for sampling speeds and accelerations, s. It is short, because an oscillation
/// averages out over a long step.
double fine_step(const Scene& s, const Swing& swing, bool swings, const MotionTable& table) {
  double step = s.time.step;
  if (swings) step = std::min(step, swing.period / 256);
  if (swings && swing.ramp > 0) step = std::min(step, swing.ramp / 256);
  for (std::size_t k = 1; k < table.time.size(); ++k)
    step = std::min(step, (table.time[k] - table.time[k - 1]) / 16);
  return std::max(step, 1e-4 * s.time.step);  // below this, differences are rounding
}

/// Greatest speed of an obstacle at any time, m/s.
double fastest_ever(const Scene& s) {
  double most = 0;
  Scene one = s;  // obstacles have different periods
  for (const Obstacle& o : s.obstacles) {
    if (!o.motion) continue;
    const bool swings = o.motion->kind == MotionKind::sine;
    one.obstacles = {o};
    one.time.step = fine_step(s, *o.motion, swings, o.motion->table);
    most = std::max(most, largest(s, *o.motion, swings, o.motion->table,
                                  [&](double a, double b) { return fastest_obstacle(one, a, b); }));
  }
  return most;
}

/// Greatest acceleration that a particle at rest feels in the tank at any time, m/s^2.
double greatest_pull_ever(const Scene& s) {
  if (!s.tank_motion) return greatest_pull(s, 0, 0);
  const TankMotion& m = *s.tank_motion;
  Scene one = s;
  const bool swings = m.kind == TankMotionKind::sine;
  one.obstacles.clear();
  one.time.step = fine_step(s, m, swings, m.table);
  return largest(s, m, swings, m.table,
                 [&](double a, double b) { return greatest_pull(one, a, b); });
}

double longest_of(const Scene& s) {
  double longest = step_rule(s).longest();
  if (const double pull = greatest_pull_ever(s); pull > 0)
    longest = std::min(longest, kSafeStep * std::sqrt(s.h() / pull));
  if (const double speed = fastest_ever(s); speed > 0)
    longest = std::min(longest, kSafeWay * s.h() / speed);
  return longest;
}

}  // namespace

void choose_step_of_motions(Scene& scene) {
  if (!has_motion(scene)) return;
  // Speeds and accelerations are means over a step, so a shorter step may show larger ones.
  for (int k = 0; k < 8; ++k) {
    const double before = scene.time.step, step = fitted_step(scene, longest_of(scene));
    if (step == 0)
      bad_input("time.step",
                "auto goes by gravity, the velocities of bodies and motions, and nothing moves; "
                "give a number");
    scene.time.step = step;
    if (k > 0 && step >= before) break;
  }
  PlacedScene placed;
  placed.scene = scene;
  placed.places[""] = "time.step: auto";
  Problems problems;
  check_scene(placed, problems);
  problems.raise();
}

}  // namespace pbf::run_module
