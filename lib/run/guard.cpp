#include "lib/run/guard.h"

#include <algorithm>
#include <cmath>

#include "lib/program/emission.h"
#include "lib/program/motion.h"
#include "lib/program/substep_lists.h"
#include "lib/program/time_levels.h"
#include "lib/scene/vector3.h"

namespace pbf::run_module {
namespace {

double mass_of(const Plan& plan) { return plan.mass * double(plan.particles); }
/// The mass at a measurement; those of earlier versions have no number of particles.
double mass_of(const Plan& plan, const Diagnostics& m) {
  return m.particles > 0 ? plan.mass * double(m.particles) : mass_of(plan);
}

constexpr double kMayGain = 0.1;  // share of the energy scale that a run may gain

/// Longest edge of the domain, h.
double longest_edge(const Scene& s) {
  const Double3 box = s.domain.max - s.domain.min;
  return std::max({box[0], box[1], box[2]}) / s.h();
}

/// Bound on the speed that prescribed motions can give the fluid, m/s.
double motion_speed(const Scene& s) {
  const double pull = greatest_pull(s, 0, s.time.end) - length(s.gravity);
  const double fastest =
      std::max(fastest_obstacle(s, 0, s.time.end), fastest_emitter(s, 0, s.time.end));
  return 2 * fastest + std::sqrt(2 * pull * longest_edge(s) * s.h());
}

/// The speed of a particle that moves by h in a substep of level 0, m/s.
double h_per_step(const Scene& s) { return s.h() / s.time.step * s.solver.substeps; }

}  // namespace

double total_energy(const Diagnostics& m) { return m.kinetic_energy + m.potential_energy - m.work; }

double energy_scale(const Diagnostics& m, const Scene& s, const Plan& plan) {
  double together = 0;
  const double mass = mass_of(plan, m);
  for (const double p : m.momentum) together += p * p / (2 * mass);
  return std::max(m.kinetic_energy - together, 0.0) + energy_of_height(m, s, mass);
}

double energy_of_height(const Diagnostics& m, const Scene& s, double mass) {
  double height = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (s.domain.is_periodic(int(a))) continue;
    const double g = s.gravity[a], x = m.center_of_mass[a];
    height += mass * std::fabs(g) * (g > 0 ? s.domain.max[a] - x : x - s.domain.min[a]);
  }
  return height;
}

double released_energy(const Diagnostics& first, const Scene& s, const Plan& plan) {
  const double share = std::max(first.compression_mean - kApart, 0.0) +
                       (s.solver.constraint == ConstraintMode::two_sided ? 0.01 : 0);
  return 0.5 * mass_of(plan) * std::pow(h_per_step(s), 2) * share;
}

std::int64_t release_updates(const Scene& s) {
  return 20 + std::int64_t(std::min(2 * longest_edge(s), 1e9));
}

double position_rounding(const Scene& s) { return longest_edge(s) * about(s.precision).roundoff; }

GuardLimits guard_limits(const Scene& s, const Plan& plan, const Diagnostics& first) {
  const GuardSettings& g = *s.guard;
  const double per_step = h_per_step(s), mass = mass_of(plan), gravity = length(s.gravity);
  const double scale = energy_scale(first, s, plan);
  double slack = 0.5 * mass * std::pow(0.01 * per_step, 2);
  if (gravity > 0) slack = std::min(slack, kMayGain * mass * gravity * s.h());
  const double rounded = 8 * position_rounding(s) * std::ldexp(per_step, finest_level(s));
  slack += 0.5 * mass * rounded * rounded;
  const double at_rest = rest_neighbors(s);
  GuardLimits l;
  l.speed =
      g.speed ? *g.speed : 10 * (first.speed_max + fall_speed(s) + motion_speed(s) + per_step);
  l.energy = total_energy(first) + (g.energy ? *g.energy * scale : kMayGain * scale + slack);
  l.neighbors =
      g.neighbors > 0 ? g.neighbors : std::max(4 * first.neighbors_max, std::int64_t(16 * at_rest));
  return l;
}

Guard::Guard(const Scene& scene, const Plan& plan, Solver& solver, const Diagnostics& first,
             const Diagnostics& now, std::optional<double> released)
    : scene_(scene),
      plan_(plan),
      solver_(solver),
      limits_(guard_limits(scene, plan, first)),
      first_(first),
      good_(now),
      released_(released) {
  follow_release(now);
  solver_.keep();
}

bool Guard::came_apart(const Diagnostics& m) const {
  // A two-sided fluid is never without compression: it releases the compression of its surface.
  return m.compression_mean <= kApart || scene_.solver.constraint == ConstraintMode::two_sided;
}

double Guard::energy_limit(const Diagnostics& m) const {
  if (scene_.guard->energy) return limits_.energy;
  const double first = energy_scale(first_, scene_, plan_);
  const double now = energy_scale(m, scene_, plan_);
  double released = 0;
  if (released_)
    released = std::max(*released_ - total_energy(first_), 0.0);
  else if (m.update <= release_updates(scene_) || came_apart(m))
    released = released_energy(first_, scene_, plan_);
  return limits_.energy + released + kMayGain * std::max(now - first, 0.0);
}

/// At most the limit of the last good measurement: later gains of energy would raise it.
double Guard::event_limit(const Diagnostics& m) const {
  return std::min(energy_limit(good_), energy_limit(m));
}

void Guard::follow_release(const Diagnostics& m) {
  if (released_) return;
  const bool late = m.update > release_updates(scene_);
  const bool surface = scene_.solver.constraint == ConstraintMode::two_sided;
  if (surface ? late : came_apart(m))
    released_ = total_energy(m);
  else if (late)
    released_ = total_energy(first_);
}

std::optional<Alarm> Guard::alarm(const Diagnostics& m) const {
  if (m.non_finite > 0) return Alarm::non_finite;
  if (m.outside > 0) return Alarm::outside;
  // With a speed limit, `fast` counts the particles that were slowed down, as the scene asked.
  if (m.speed_max > limits_.speed || (scene_.solver.speed_limit == 0 && m.fast > good_.fast))
    return Alarm::speed;
  if (m.neighbors_max > limits_.neighbors) return Alarm::neighbors;
  if (!(total_energy(m) <= energy_limit(m))) return Alarm::energy;
  return std::nullopt;
}

void Guard::keep(const Diagnostics& m) {
  solver_.keep();
  good_ = m;
  follow_release(m);
}

GuardEvent Guard::locate(Alarm alarm, const Diagnostics& m, const StepOptions& options) {
  GuardEvent e;
  e.alarm = alarm;
  e.measure = m;
  const double h = scene_.h(), to_internal = 1 / (plan_.mass * h * h);
  const double energy = event_limit(m);
  // Stages do not know the work of motions, so it is added to their limit.
  const StageLimits limits{limits_.speed / h, (energy + m.work) * to_internal, limits_.neighbors};
  e.last_good = solver_.state(StateOf::kept);
  solver_.set_state(e.last_good);
  while (!e.stage && solver_.updates() < e.measure.update)
    e.stage = solver_.inspection()->step_checked(limits, options);
  if (e.stage) {
    e.alarm = e.stage->alarm;  // the first fault, for example a speed that later became a NaN
    for (std::size_t a = 0; a < 3; ++a) {
      e.position[a] = scene_.origin()[a] + h * e.stage->position[a];
      e.velocity[a] = h * e.stage->velocity[a];
    }
  }
  switch (e.alarm) {
    case Alarm::speed:
      e.limit = limits_.speed;
      e.value = e.stage ? h * e.stage->value : e.measure.speed_max;
      break;
    case Alarm::energy:
      e.limit = energy;
      e.value = e.stage ? e.stage->value / to_internal - m.work : total_energy(e.measure);
      break;
    case Alarm::neighbors:
      e.limit = double(limits_.neighbors);
      e.value = e.stage ? e.stage->value : double(e.measure.neighbors_max);
      break;
    default:
      e.value = e.stage ? e.stage->value : double(e.measure.non_finite + e.measure.outside);
  }
  return e;
}

}  // namespace pbf::run_module
