#include "lib/run/watch.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace pbf::run_module {

Watch::Watch(const Scene& scene, const Plan& plan, Solver& solver, Take take,
             std::function<void(const std::string&)> note, StageClock* clock)
    : scene_(scene),
      plan_(plan),
      solver_(solver),
      take_(std::move(take)),
      note_(std::move(note)),
      clock_(clock),
      schedule_(make_schedule(scene)) {}

Diagnostics& Watch::go_on_from(const SavedRun& saved) {
  first_ = saved.first;
  first_.energy = saved.energy.first;
  work_ = WorkTrack(saved.energy);
  last_ = measured();
  begin(last_, saved.steps.value_or(StepHistory{}), saved.released);
  if (schedule_.measures(last_.update)) taken_ = last_.update;
  return last_;
}

void Watch::begin(const Diagnostics& now, const StepHistory& before,
                  std::optional<double> released) {
  begun_ = true;
  if (scene_.guard) guard_.emplace(scene_, plan_, solver_, first_, now, released);
  if (scene_.time.adaptive) step_.emplace(scene_, before);
}

std::int64_t Watch::next(std::int64_t u) const {
  const std::int64_t next = goes_back() ? schedule_.next_event(u) : schedule_.next_measure(u);
  return take_gauges_ ? std::min(next, schedule_.next_gauges(u)) : next;
}

Now Watch::at(Session& session) {
  const std::optional<GaugeRow> row = gauges();
  bool stays = true;
  if (schedule_.measures(session.update()))
    stays = measure(true);
  else if (goes_back() || !row)
    stays = look(measured());
  if (row && stays) take_gauges_(*row);
  session.use(options());
  return event_ ? Now::stop : Now::go_on;
}

/// Stopped between two measurements; a state that it went back to is known to be good.
void Watch::end(Session& session) {
  if (!event_ && taken_ != session.update()) measure(!goes_back());
}

std::int64_t Watch::next_choice(std::int64_t u) const {
  return scene_.time.adaptive ? next_multiple(u, schedule_.measure_every) : kNever;
}

Now Watch::choose(Session& session) {
  booked([&] {
    const int level = step_->level();
    if (const auto change = step_->follow(last_)) take(*change, level);
  });
  session.use(options());
  return Now::go_on;
}

bool Watch::state_is_good() {
  if (guard_ && !goes_back() && taken_ != solver_.updates()) look(measured());
  return !event_;
}

/// Reads the gauges if they are due, before a state is kept, as for loads.
std::optional<GaugeRow> Watch::gauges() {
  const std::int64_t u = solver_.updates();
  if (!take_gauges_ || !schedule_.reads_gauges(u)) return std::nullopt;
  const bool regular = u % schedule_.gauge_every == 0;
  return GaugeRow{u, double(u) * scene_.time.step,
                  solver_.readings(Series::gauges, regular ? Interval::ends : Interval::goes_on)};
}

Diagnostics Watch::measured() {
  Diagnostics m = solver_.measure();
  m.work = work_.until(m);
  return m;
}

/// Returns whether the measurement stays: false if the session goes back.
bool Watch::measure(bool judged) {
  Diagnostics m = measured();
  // Read them before a state is kept, so that going back does not repeat them. A row between two
  // regular measurements, which a longer run would not have, ends no interval.
  const bool regular = m.update % schedule_.measure_every == 0;
  m.readings = solver_.readings(Series::measures, regular ? Interval::ends : Interval::goes_on);
  const bool first = !begun_;
  if (first) first_ = m, begin(m, {}, {});
  const double dt = std::ldexp(scene_.time.step, -options().level);
  if (judged && !look(m)) return false;
  if (regular) work_.take(m);
  taken_ = m.update;
  last_ = m;
  take_(last_, dt);
  if (first) first_ = last_;
  return true;
}

/// Returns whether the measurement stays: false if the session goes back.
bool Watch::look(const Diagnostics& m) {
  bool stays = true;
  if (guard_) booked([&] { stays = judge(m); });
  return stays;
}

/// If alarms take a run back, its state is kept before any of it is written.
bool Watch::judge(const Diagnostics& m) {
  const std::optional<Alarm> alarm = guard_->alarm(m);
  if (!alarm) {
    if (!goes_back() || schedule_.has(m.update)) guard_->keep(m);
    return true;
  }
  const std::int64_t back = guard_->last_good().update;
  // A fault at the start does not depend on the step.
  if (step_ && back < m.update) {
    const int before = step_->level();
    if (const auto change = step_->refine(kAlarmNames[static_cast<int>(*alarm)], m, back)) {
      go_back();
      take(*change, before);
      return false;
    }
  }
  event_ = guard_->locate(*alarm, m, options());
  return true;
}

/// Records the time of `action`, except that which the solver records itself.
void Watch::booked(const std::function<void()>& action) {
  const auto solver_seconds = [&] {
    double sum = 0;
    for (const StageTime& s : solver_.info().stages) sum += s.seconds;
    return sum;
  };
  const double before = solver_seconds();
  const Stopwatch stopwatch;
  action();
  if (clock_) clock_->add("guard", stopwatch.seconds() - (solver_seconds() - before));
}

void Watch::go_back() {
  if (solver_.updates() != guard_->last_good().update)
    solver_.set_state(solver_.state(Which::kept));
}

StepOptions Watch::options() const {
  StepOptions o = guard_ ? guard_->options() : StepOptions{};
  if (step_) o.level = step_->level();
  return o;
}

std::optional<StepHistory> Watch::steps(std::optional<std::int64_t> update) const {
  if (!step_) return std::nullopt;
  StepHistory h = step_->history();
  if (update) h.updates = step_->updates_at_levels(*update);
  return h;
}

void Watch::take(const std::string& change, int level_before) {
  const int finer = step_->level() - level_before;
  note_(change + (finer > 0 ? prestabilize(finer) : std::string()));
}

/// Reduces the compression by 4^levels before shorter steps begin, which would turn it into energy
/// (lib/solver/DIAGNOSTICS.md, "Compression at rest"): first steps without time, then a damping of
/// the velocities that takes away the energy by which these steps lifted the fluid.
std::string Watch::prestabilize(int levels) {
  constexpr int kMost = 64, kAtOnce = 4;
  constexpr double kHarmless = 1e-3;
  Diagnostics m = measured();
  const double compression = m.compression_mean, energy = total_energy(m);
  const double target = std::ldexp(compression, -2 * levels);
  if (std::ldexp(compression, 2 * levels) <= kHarmless) return {};
  int steps = 0;
  for (; steps < kMost && m.compression_mean > target; steps += kAtOnce) {
    solver_.step(kAtOnce, {.without_time = 1.0});
    m = measured();
  }
  const double lifted = total_energy(m) - energy;
  if (lifted > 0 && m.kinetic_energy > 0) {
    const double damping = std::sqrt(std::max(0.0, 1 - lifted / m.kinetic_energy));
    solver_.step(1, {.without_time = damping});
    ++steps;
    m = measured();
  }
  if (guard_) guard_->keep(m);
  return fmt::format("; mean compression {:.3g} %, {:.3g} % after {} steps without time",
                     100 * compression, 100 * m.compression_mean, steps);
}

}  // namespace pbf::run_module
