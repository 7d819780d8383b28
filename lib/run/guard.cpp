#include "lib/run/guard.h"

#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/program/substep_lists.h"
#include "lib/program/time_levels.h"

namespace pbf::inline run_module {
namespace {

double length(const double (&v)[3]) { return std::hypot(v[0], v[1], v[2]); }

double mass_of(const Plan& plan) { return plan.mass * double(plan.particles); }

constexpr double kShare = 0.1;   // of the energy scale, that a run may gain
constexpr double kApart = 0.01;  // mean compression of a start that has come apart

double gravity_of(const Scene& s) { return std::hypot(s.gravity[0], s.gravity[1], s.gravity[2]); }

/// h, of the domain.
double longest_edge(const Scene& s) {
  double edge = 0;
  for (std::size_t a = 0; a < 3; ++a) edge = std::max(edge, s.domain.max[a] - s.domain.min[a]);
  return edge / s.h();
}

/// m/s, of a move by h in a step of level 0.
double h_per_step(const Scene& s) { return s.h() / s.time.step * s.solver.substeps; }

/// What each alarm is about: words for it, unit, and its key.
struct Words {
  const char *what, *unit, *limit_key;
};
Words words(Alarm alarm) {
  switch (alarm) {
    case Alarm::non_finite:
      return {"is not finite", "", ""};
    case Alarm::outside:
      return {"is outside the walls", "", ""};
    case Alarm::speed:
      return {"is too fast", "m/s", "guard.speed"};
    case Alarm::energy:
      return {"is the fastest while the energy grows without a source", "J", "guard.energy"};
    case Alarm::neighbors:
      return {"has too many neighbours", "", "guard.neighbors"};
  }
  return {};
}

}  // namespace

double total_energy(const Measures& m) { return m.kinetic_energy + m.potential_energy; }

double energy_scale(const Measures& m, const Scene& s, double mass, std::int64_t particles) {
  const double all = mass * double(particles);
  double together = 0;
  for (const double p : m.momentum) together += p * p / (2 * all);
  return std::max(m.kinetic_energy - together, 0.0) + energy_of_height(m, s, mass, particles);
}

double energy_of_height(const Measures& m, const Scene& s, double mass, std::int64_t particles) {
  const double all = mass * double(particles);
  double height = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double g = s.gravity[a], x = m.center_of_mass[a];
    height += all * std::fabs(g) * (g > 0 ? s.domain.max[a] - x : x - s.domain.min[a]);
  }
  return height;
}

double released_energy(const Measures& first, const Scene& s, const Plan& plan) {
  const double share = std::max(first.compression_mean - kApart, 0.0) +
                       (s.solver.constraint == ConstraintMode::two_sided ? 0.01 : 0);
  return 0.5 * mass_of(plan) * std::pow(h_per_step(s), 2) * share;
}

std::int64_t release_updates(const Scene& s) {
  return 20 + std::int64_t(std::min(2 * longest_edge(s), 1e9));
}

double position_rounding(const Scene& s) {
  return longest_edge(s) * (s.precision == Precision::dbl ? 0x1p-53 : 0x1p-24);
}

GuardLimits guard_limits(const Scene& s, const Plan& plan, const Measures& first) {
  const GuardSettings& g = *s.guard;
  const double per_step = h_per_step(s), mass = mass_of(plan), gravity = gravity_of(s);
  const double scale = energy_scale(first, s, plan.mass, plan.particles);
  double slack = 0.5 * mass * std::pow(0.01 * per_step, 2);
  if (gravity > 0) slack = std::min(slack, kShare * mass * gravity * s.h());
  const double rounded = 8 * position_rounding(s) * std::ldexp(per_step, finest_level(s));
  slack += 0.5 * mass * rounded * rounded;
  const double at_rest = rest_neighbors(s);
  GuardLimits l;
  l.speed = g.speed ? *g.speed : 10 * (first.speed_max + fall_speed(s) + per_step);
  l.energy = total_energy(first) + (g.energy ? *g.energy * scale : kShare * scale + slack);
  l.neighbors =
      g.neighbors > 0 ? g.neighbors : std::max(4 * first.neighbors_max, std::int64_t(16 * at_rest));
  return l;
}

Guard::Guard(const Scene& scene, const Plan& plan, Solver& solver, const Measures& first,
             const Measures& now, std::optional<double> released)
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

bool Guard::came_apart(const Measures& m) const {
  // A two-sided fluid is never without compression: what it releases is that of its surface.
  return m.compression_mean <= kApart || scene_.solver.constraint == ConstraintMode::two_sided;
}

double Guard::energy_limit(const Measures& m) const {
  if (scene_.guard->energy) return limits_.energy;
  const double first = energy_scale(first_, scene_, plan_.mass, plan_.particles);
  const double now = energy_scale(m, scene_, plan_.mass, plan_.particles);
  double released = 0;
  if (released_)
    released = std::max(*released_ - total_energy(first_), 0.0);
  else if (m.update <= release_updates(scene_) || came_apart(m))
    released = released_energy(first_, scene_, plan_);
  return limits_.energy + released + kShare * std::max(now - first, 0.0);
}

/// That of the last good measure at most: the energy that has come since widens the limit of `m`.
double Guard::event_limit(const Measures& m) const {
  return std::min(energy_limit(good_), energy_limit(m));
}

void Guard::follow_release(const Measures& m) {
  if (released_) return;
  const bool late = m.update > release_updates(scene_);
  const bool surface = scene_.solver.constraint == ConstraintMode::two_sided;
  if (surface ? late : came_apart(m))
    released_ = total_energy(m);
  else if (late)
    released_ = total_energy(first_);
}

std::optional<Alarm> Guard::alarm(const Measures& m) const {
  if (m.non_finite > 0) return Alarm::non_finite;
  if (m.outside > 0) return Alarm::outside;
  // With a speed limit the count is that of particles slowed down, which the scene asked for.
  if (m.speed_max > limits_.speed || (scene_.solver.speed_limit == 0 && m.fast > good_.fast))
    return Alarm::speed;
  if (m.neighbors_max > limits_.neighbors) return Alarm::neighbors;
  if (!(total_energy(m) <= energy_limit(m))) return Alarm::energy;
  return std::nullopt;
}

std::optional<GuardEvent> Guard::check(const Measures& m) {
  if (const std::optional<Alarm> wrong = alarm(m)) return locate(*wrong, m, options());
  keep(m);
  return std::nullopt;
}

void Guard::keep(const Measures& m) {
  solver_.keep();
  good_ = m;
  follow_release(m);
}

GuardEvent Guard::locate(Alarm alarm, const Measures& m, const StepOptions& options) {
  GuardEvent e;
  e.alarm = alarm;
  e.measure = m;
  const double h = scene_.h(), to_internal = 1 / (plan_.mass * h * h);
  const double energy = event_limit(m);
  const StageLimits limits{limits_.speed / h, energy * to_internal, limits_.neighbors};
  e.last_good = solver_.state(Which::kept);
  solver_.set_state(e.last_good);
  while (!e.stage && solver_.updates() < e.measure.update)
    e.stage = solver_.inspection()->step_checked(limits, options);
  if (e.stage) {
    e.alarm = e.stage->alarm;  // what came first: a speed, say, before it ended as a NaN
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
      e.value = e.stage ? e.stage->value / to_internal : total_energy(e.measure);
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

std::string Guard::text(const GuardEvent& e) const {
  const Words w = words(e.alarm);
  std::string out = "stopped by the guard: ";
  if (e.stage) {
    const double v[3] = {e.velocity[0], e.velocity[1], e.velocity[2]};
    out += format("at update %lld, in stage %s", static_cast<long long>(e.stage->update),
                  e.stage->stage.c_str());
    if (e.stage->sweep > 0) out += format(" of sweep %d", e.stage->sweep);
    out += format(
        ", particle %d at (%.6g, %.6g, %.6g) m, velocity (%.4g, %.4g, %.4g) m/s "
        "(%.4g m/s), %s",
        e.stage->id, e.position[0], e.position[1], e.position[2], v[0], v[1], v[2], length(v),
        w.what);
  } else if (e.last_good.updates == e.measure.update) {
    out += format("at the start, before the first update, a particle %s", w.what);
  } else {
    out += format(
        "between the updates %lld and %lld (the repeated updates did not show it again) "
        "a particle %s",
        static_cast<long long>(e.last_good.updates), static_cast<long long>(e.measure.update),
        w.what);
  }
  const std::string unit = w.unit[0] ? std::string(" ").append(w.unit) : std::string();
  out += format(": %.6g%s", e.value, unit.c_str());
  if (w.limit_key[0]) out += format(", limit %.6g%s (%s)", e.limit, unit.c_str(), w.limit_key);
  if (scene_.time.adaptive) {
    const Scene finest = scene_at_level(scene_, finest_level(scene_));
    out += format("; with the shortest step, %.6g s (time.adaptive.step_min)", finest.time.step);
  }
  return out + format("; seen at t = %.6g s. To help: %s", e.measure.time, remedy(e).c_str());
}

/// The keys that help, by what there is to blame.
std::string Guard::remedy(const GuardEvent& e) const {
  const std::string stage = e.stage ? e.stage->stage : std::string();
  if (stage == "xsph") return "lower viscosity.xsph";
  if (stage == "curl" || stage == "vorticity") return "lower vorticity.epsilon";
  const bool shaken = e.alarm == Alarm::speed || e.alarm == Alarm::energy;
  if (first_.compression_mean > kApart && (e.alarm == Alarm::neighbors || shaken)) {
    std::string help =
        format("the start is compressed by %.3g %% (mean)", 100 * first_.compression_mean);
    if (!scene_.solver.prestabilize) help += "; leave solver.prestabilize on";
    help += "; spread the bodies, or give them room";
    if (scene_.fluid.mass) help += "; check fluid.mass";
    return help + ". A shorter time.step makes it worse";
  }
  std::string help;
  if (shaken && scene_.tensile) help += "lower tensile.k, which acts as k/time.step^2; ";
  if (shaken && scene_.solver.constraint == ConstraintMode::two_sided)
    help += "use solver.constraint: one_sided; ";
  switch (e.alarm) {
    case Alarm::speed:
      return help + "lower time.step, raise solver.iterations, or ask for solver.speed_limit";
    case Alarm::energy:
      return help + "lower time.step, raise solver.iterations, or lower solver.sor";
    case Alarm::neighbors:
      return "raise solver.iterations, lower time.step, or spread the bodies";
    default:
      return "lower time.step, or raise solver.iterations";
  }
}

Scene Guard::repeating_scene(const GuardEvent& e, const std::string& path) const {
  const int level = finest_level(scene_);  // a coarser one would not have ended the run
  Scene s = scene_at_level(scene_, level);
  s.time.adaptive.reset();
  s.solver.prestabilize = false;  // it goes on from a state
  s.name += "_event";
  Body body;
  body.shape = Shape::file;
  body.path = path;
  s.bodies = {body};
  s.output.reset();
  s.render.reset();
  s.measure_every = 1;
  const std::int64_t updates = (e.measure.update - e.last_good.updates) << level;
  s.time.end = s.time.step * double(std::max<std::int64_t>(updates, 1) + 2);
  // The same limits, though the run starts elsewhere.
  s.guard->speed = limits_.speed;
  s.guard->neighbors = limits_.neighbors;
  const double scale = energy_scale(good_, s, plan_.mass, plan_.particles);
  if (scale > 0)
    s.guard->energy = std::max((event_limit(e.measure) - total_energy(good_)) / scale, 1e-12);
  return s;
}

Particles to_particles(const SolverState& state, const Scene& s) {
  Particles p;
  p.position.resize(state.id.size());
  p.velocity.resize(state.id.size());
  const double h = s.h();
  for (std::size_t i = 0; i < state.id.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const auto id = std::size_t(state.id[i]);
      p.position[id][a] = std::clamp(s.origin()[a] + h * state.position[3 * i + a], s.domain.min[a],
                                     s.domain.max[a]);
      p.velocity[id][a] = h * state.velocity[3 * i + a];
    }
  return p;
}

}  // namespace pbf::inline run_module
