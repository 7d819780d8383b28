// Texts of the guard, and the scene that repeats an alarm.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/program/field.h"
#include "lib/program/free_bodies.h"
#include "lib/program/motion.h"
#include "lib/program/time_levels.h"
#include "lib/program/time_order.h"
#include "lib/run/guard.h"
#include "lib/run/linked_files.h"
#include "lib/scene/vector3.h"

namespace pbf::run_module {
namespace {

/// Texts for each alarm: what is wrong, unit with a leading blank, key of the limit, remedy.
struct Words {
  const char *what, *unit, *limit_key, *help;
};
constexpr const char* kShorterStep = "lower time.step, or raise solver.iterations";
constexpr Words kWords[] = {
    // in the order of Alarm
    {"is not finite", "", "", kShorterStep},
    {"is outside the walls", "", "", kShorterStep},
    {"is too fast", " m/s", "guard.speed",
     "lower time.step, raise solver.iterations, or ask for solver.speed_limit"},
    {"is the fastest while the energy grows without a source", " J", "guard.energy",
     "lower time.step, raise solver.iterations, or lower solver.sor"},
    {"has too many neighbors", "", "guard.neighbors",
     "raise solver.iterations, lower time.step, or spread the bodies"}};
const Words& words(Alarm alarm) { return kWords[static_cast<int>(alarm)]; }

}  // namespace

std::string Guard::text(const GuardEvent& e) const {
  const Words& w = words(e.alarm);
  std::string out = "stopped by the guard: ";
  if (e.stage) {
    const Double3& v = e.velocity;
    out += fmt::format("at update {}, in stage {}", e.stage->update, e.stage->stage);
    if (e.stage->iteration > 0) out += fmt::format(" of iteration {}", e.stage->iteration);
    out += fmt::format(
        ", particle {} at ({:.6g}, {:.6g}, {:.6g}) m, velocity ({:.4g}, {:.4g}, {:.4g}) m/s "
        "({:.4g} m/s), {}",
        e.stage->id, e.position[0], e.position[1], e.position[2], v[0], v[1], v[2], length(v),
        w.what);
  } else if (e.last_good.updates == e.measure.update) {
    out += fmt::format("at the start, before the first update, a particle {}", w.what);
  } else {
    out += fmt::format(
        "between the updates {} and {} (the repeated updates did not show it again) a particle {}",
        e.last_good.updates, e.measure.update, w.what);
  }
  out += fmt::format(": {:.6g}{}", e.value, w.unit);
  if (w.limit_key[0]) out += fmt::format(", limit {:.6g}{} ({})", e.limit, w.unit, w.limit_key);
  if (scene_.time.adaptive) {
    const Scene finest = scene_at_level(scene_, finest_level(scene_));
    out += fmt::format("; with the shortest step, {:.6g} s (time.adaptive.step_min)",
                       finest.time.step);
  }
  return out + fmt::format("; seen at t = {:.6g} s. To help: {}", e.measure.time, remedy(e));
}

/// The keys to change, depending on the cause.
std::string Guard::remedy(const GuardEvent& e) const {
  if (e.stage && !e.stage->remedy.empty()) return e.stage->remedy;
  const bool shaken = e.alarm == Alarm::speed || e.alarm == Alarm::energy;
  if (first_.compression_mean > kApart && (e.alarm == Alarm::neighbors || shaken)) {
    std::string help =
        fmt::format("the start is compressed by {:.3g} % (mean)", 100 * first_.compression_mean);
    if (!scene_.solver.prestabilize) help += "; leave solver.prestabilize on";
    help += "; spread the bodies, or give them room";
    if (scene_.fluid.mass) help += "; check fluid.mass";
    return help + ". A shorter time.step makes it worse";
  }
  std::string help;
  if (shaken && scene_.tensile) help += "lower tensile.k, which acts as k/time.step^2; ";
  if (shaken && scene_.solver.constraint == ConstraintMode::two_sided)
    help += "use solver.constraint: one_sided; ";
  return help + words(e.alarm).help;
}

Scene Guard::repeating_scene(const GuardEvent& e, const std::string& path) const {
  const int level = finest_level(scene_);  // at a coarser level the run would have continued
  Scene s = begun_with_bodies(scene_at_level(scene_, level), good_.bodies);
  s.time.adaptive.reset();
  s.solver.prestabilize = false;  // it starts from a state of the run
  s.settle.reset();
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
  if (has_motion(s)) {  // motions continue, and tables may end with the run
    const double done = double(e.last_good.updates) * scene_.time.step;
    s.time.motion_begin += done;
    s.time.end = std::max(std::min(s.time.end, scene_.time.end - done), s.time.step);
  }
  make_paths_absolute(s);
  // Keep the limits of the original run, although this one starts elsewhere.
  s.guard->speed = limits_.speed;
  s.guard->neighbors = limits_.neighbors;
  const double scale = energy_scale(good_, s, plan_);
  if (scale > 0)
    s.guard->energy = std::max((event_limit(e.measure) - total_energy(good_)) / scale, 1e-12);
  return s;
}

namespace {

/// Velocities of a state of second order, h/s, which are those of half a step earlier, become those
/// from which a run that starts anew makes the prediction that the state would make: half of the
/// next step's acceleration is added, which a start subtracts, and the share of the last push.
void start_anew(const SolverState& state, const Scene& s, std::vector<Double3>& velocity) {
  const StoredField *free = state.find(field::free_velocity.name),
                    *last = state.find(kStepLengthField);
  if (!free || !last || !(last->values[0] > 0)) return;
  const Scene next = scene_at_level(s, finest_level(s));
  const double dt = next.time.step / next.solver.substeps, ratio = dt / last->values[0];
  const FrameStep<double> step = frame_step(s, {}, double(state.updates) * s.time.step, dt);
  const auto row = [](const std::vector<double>& all, std::size_t i) {
    return Vec3<double>{all[3 * i], all[3 * i + 1], all[3 * i + 2]};
  };
  // u = f(u), for an f that changes little with u or not at all.
  const auto solved = [](const auto& f, Vec3<double> u) {
    for (int k = 0; k < 40; ++k) {
      const Vec3<double> found = f(u);
      if (found.x == u.x && found.y == u.y && found.z == u.z) break;
      u = found;
    }
    return u;
  };
  const double damping = std::pow(next.solver.velocity_damping, 1.0 / next.solver.substeps);
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const Vec3<double> x = row(state.position, i), v = row(state.velocity, i);
    const auto gain = [&](const Vec3<double>& u) { return step.accelerated(x, u) - u; };
    // The change of the step length first, as ChangeStepPass makes it.
    const Vec3<double> push = ratio * (v - row(free->values, i)),
                       now = v - 0.5 * (1 - 1 / ratio) * (gain(v) + push),
                       predicted = step.accelerated(x, damping * now) + kCarriedPush * push;
    // In a tank that turns, the acceleration depends a little on the velocity.
    Vec3<double> u = solved([&](const auto& w) { return predicted - gain(w); }, now);
    if (damping > 0) u = (1 / damping) * u;
    const Vec3<double> start = solved([&](const auto& w) { return u + 0.5 * gain(w); }, now);
    velocity[i] = {start.x, start.y, start.z};
  }
}

}  // namespace

Particles to_particles(const SolverState& state, const Scene& s) {
  Particles p;
  p.position.resize(state.id.size());
  p.velocity.resize(state.id.size());
  const double h = s.h();
  for (std::size_t i = 0; i < state.id.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      p.position[i][a] = std::clamp(s.origin()[a] + h * state.position[3 * i + a], s.domain.min[a],
                                    s.domain.max[a]);
      p.velocity[i][a] = state.velocity[3 * i + a];
    }
  start_anew(state, s, p.velocity);
  for (Double3& v : p.velocity) v = h * v;
  return p;
}

}  // namespace pbf::run_module
