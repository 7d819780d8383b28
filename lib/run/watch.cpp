#include "lib/run/watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lib/base/text.h"

namespace pbf::inline run_module {

Watch::Watch(const Scene& scene, const Plan& plan, Solver& solver, const Measures& first,
             const Measures& now, std::function<void(const std::string&)> note,
             const StepHistory& before, std::optional<double> released)
    : whole_(scene.time.step), solver_(solver), note_(std::move(note)) {
  if (scene.guard) guard_.emplace(scene, plan, solver, first, now, released);
  if (scene.time.adaptive) step_.emplace(scene, before);
}

Verdict Watch::look(const Measures& m, bool keep) {
  if (!guard_) return Verdict::good;
  const std::optional<Alarm> alarm = guard_->alarm(m);
  if (!alarm) {
    if (keep) guard_->keep(m);
    return Verdict::good;
  }
  const std::int64_t back = guard_->last_good().update;
  // What is wrong at the start is wrong with any step.
  if (step_ && back < m.update) {
    const int before = step_->level();
    if (const auto change = step_->refine(kAlarmNames[static_cast<int>(*alarm)], m, back)) {
      go_back();
      take(*change, before);
      return Verdict::back;
    }
  }
  event_ = guard_->locate(*alarm, m, options());
  return Verdict::stop;
}

void Watch::choose(const Measures& m) {
  if (!step_) return;
  const int before = step_->level();
  if (const auto change = step_->follow(m)) take(*change, before);
}

void Watch::go_back() {
  if (solver_.updates() != guard_->last_good().update)
    solver_.set_state(solver_.state(Which::kept));
}

double Watch::step() const { return step_ ? step_->step(step_->level()) : whole_; }

StepOptions Watch::options() const {
  StepOptions o = guard_ ? guard_->options() : StepOptions{};
  if (step_) o.level = step_->level();
  return o;
}

void Watch::take(const std::string& change, int level_before) {
  const int finer = step_->level() - level_before;
  note_(change + (finer > 0 ? relax(finer) : std::string()));
}

/// A step of dt holds up the fluid with a compression in proportion to dt^2. Left to a step 2^k
/// times shorter, it pushes with 4^k times the weight of the fluid and throws it up: with one sweep
/// and dt sqrt(g/h) = 0.2 a pool of 12 layers, gone back to a mean compression of 39 %, gained 7
/// times its energy with a step 64 times shorter. So the compression is first taken down by 4^k,
/// in steps without time (Macklin et al. 2014, Unified particle physics for real-time applications,
/// ACM TOG 33(4), part contacts that are there at the start so), and what lifting the fluid adds to
/// its energy is taken from its motion.
std::string Watch::relax(int levels) {
  constexpr int kMost = 64, kAtOnce = 4;
  constexpr double kHarmless = 1e-3;
  Measures m = solver_.measure();
  const double compression = m.compression_mean, energy = total_energy(m);
  const double target = std::ldexp(compression, -2 * levels);
  if (std::ldexp(compression, 2 * levels) <= kHarmless) return {};
  int steps = 0;
  for (; steps < kMost && m.compression_mean > target; steps += kAtOnce) {
    solver_.step(kAtOnce, {.without_time = 1.0});
    m = solver_.measure();
  }
  const double lifted = total_energy(m) - energy;
  if (lifted > 0 && m.kinetic_energy > 0) {
    const double damping = std::sqrt(std::max(0.0, 1 - lifted / m.kinetic_energy));
    solver_.step(1, {.without_time = damping});
    ++steps;
    m = solver_.measure();
  }
  if (guard_) guard_->keep(m);
  return format("; mean compression %.3g %%, %.3g %% after %d steps without time",
                100 * compression, 100 * m.compression_mean, steps);
}

}  // namespace pbf::inline run_module
