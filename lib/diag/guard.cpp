#include "lib/diag/guard.h"

#include <algorithm>
#include <cmath>

#include "lib/base/text.h"
#include "lib/plan/substep_lists.h"
#include "lib/solver/adaptive_step.h"

namespace pbf {
namespace {

double length(const double (&v)[3]) { return std::hypot(v[0], v[1], v[2]); }

double mass_of(const Plan& plan) { return plan.mass * double(plan.particles); }

/// What each alarm is about: words for it, unit, and the keys that help.
struct Words {
  const char *what, *unit, *limit_key, *remedy;
};
Words words(Alarm alarm) {
  const char* softer = "lower time.step, or raise solver.iterations";
  switch (alarm) {
    case Alarm::non_finite:
      return {"is not finite", "", "", softer};
    case Alarm::outside:
      return {"is outside the walls", "", "", softer};
    case Alarm::speed:
      return {"is too fast", "m/s", "guard.speed",
              "lower time.step, raise solver.iterations, or ask for solver.speed_limit"};
    case Alarm::energy:
      return {"is the fastest while the energy grows without a source", "J", "guard.energy",
              "lower time.step, raise solver.iterations, or lower solver.step_length"};
    case Alarm::neighbors:
      return {"has too many neighbours", "", "guard.neighbors",
              "raise solver.iterations, lower time.step, or spread the bodies"};
  }
  return {};
}

}  // namespace

double total_energy(const Measures& m) { return m.kinetic_energy + m.potential_energy; }

double energy_scale(const Measures& m, const Scene& s, double mass, std::int64_t particles) {
  double scale = m.kinetic_energy;
  for (std::size_t a = 0; a < 3; ++a) {
    const double g = s.gravity[a], x = m.center_of_mass[a];
    scale += mass * double(particles) * std::fabs(g) *
             (g > 0 ? s.domain.max[a] - x : x - s.domain.min[a]);
  }
  return scale;
}

double released_energy(const Measures& first, const Scene& s, const Plan& plan) {
  const double per_step = s.h() / s.time.step * s.solver.substeps;
  const double share = std::max(first.compression_mean - 0.01, 0.0) +
                       (s.solver.constraint == ConstraintMode::two_sided ? 1 : 0);
  return 0.5 * mass_of(plan) * per_step * per_step * share;
}

GuardLimits guard_limits(const Scene& s, const Plan& plan, const Measures& first) {
  const GuardSettings& g = *s.guard;
  const double per_step = s.h() / s.time.step * s.solver.substeps, mass = mass_of(plan);
  const double scale = energy_scale(first, s, plan.mass, plan.particles);
  const double rounding = 0.5 * mass * std::pow(0.01 * per_step, 2);
  const double at_rest = rest_neighbors(s);
  GuardLimits l;
  l.speed = g.speed ? *g.speed : 10 * (first.speed_max + fall_speed(s) + per_step);
  l.energy =
      total_energy(first) +
      (g.energy ? *g.energy * scale : 0.1 * scale + released_energy(first, s, plan) + rounding);
  l.neighbors =
      g.neighbors > 0 ? g.neighbors : std::max(4 * first.neighbors_max, std::int64_t(16 * at_rest));
  return l;
}

Guard::Guard(const Scene& scene, const Plan& plan, Solver& solver, const Measures& first,
             const Measures& now)
    : scene_(scene),
      plan_(plan),
      solver_(solver),
      limits_(guard_limits(scene, plan, first)),
      good_(now) {
  solver_.watch_speed(limits_.speed);
  solver_.keep();
}

std::optional<Alarm> Guard::alarm(const Measures& m) const {
  if (m.non_finite > 0) return Alarm::non_finite;
  if (m.outside > 0) return Alarm::outside;
  // With a speed limit the count is that of particles slowed down, which the scene asked for.
  if (m.speed_max > limits_.speed || (scene_.solver.speed_limit == 0 && m.fast > good_.fast))
    return Alarm::speed;
  if (m.neighbors_max > limits_.neighbors) return Alarm::neighbors;
  if (!(total_energy(m) <= limits_.energy)) return Alarm::energy;
  return std::nullopt;
}

std::optional<GuardEvent> Guard::check(const Measures& m) {
  if (const std::optional<Alarm> wrong = alarm(m)) return locate(*wrong, m);
  keep(m);
  return std::nullopt;
}

void Guard::keep(const Measures& m) {
  solver_.keep();
  good_ = m;
}

GuardEvent Guard::locate(Alarm alarm, const Measures& m) {
  GuardEvent e;
  e.alarm = alarm;
  e.measure = m;
  const double h = scene_.h(), to_internal = 1 / (plan_.mass * h * h);
  const StageLimits limits{limits_.speed / h, limits_.energy * to_internal, limits_.neighbors};
  e.last_good = solver_.kept();
  solver_.set_state(e.last_good);
  while (!e.stage && solver_.updates_done() < e.measure.update)
    e.stage = solver_.step_checked(limits);
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
      e.limit = limits_.energy;
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
  return out + format("; seen at t = %.6g s. To help: %s", e.measure.time, w.remedy);
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
  if (scale > 0) s.guard->energy = std::max((limits_.energy - total_energy(good_)) / scale, 1e-12);
  return s;
}

Particles to_particles(const SolverState& state, const Scene& s) {
  Particles p;
  const double h = s.h();
  for (std::size_t i = 0; i < state.id.size(); ++i) {
    Double3 x, v;
    for (std::size_t a = 0; a < 3; ++a) {
      x[a] = std::clamp(s.origin()[a] + h * state.position[3 * i + a], s.domain.min[a],
                        s.domain.max[a]);
      v[a] = h * state.velocity[3 * i + a];
    }
    p.position.push_back(x);
    p.velocity.push_back(v);
  }
  return p;
}

}  // namespace pbf
