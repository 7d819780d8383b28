#include "lib/run/monitor.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lib/solver/split_rows.h"

namespace pbf::run_module {

Monitor::Monitor(const Scene& scene, const Plan& plan, Solver& solver, Record record,
                 std::function<void(const std::string&)> note, StageClock* clock)
    : scene_(scene),
      plan_(plan),
      solver_(solver),
      record_(std::move(record)),
      note_(std::move(note)),
      clock_(clock),
      schedule_(make_schedule(scene)) {}

Diagnostics& Monitor::go_on_from(const SavedRun& saved) {
  first_ = saved.first;
  first_.energy = saved.energy.first;
  work_ = WorkTrack(saved.energy);
  last_ = diagnose();
  begin(last_, saved.steps.value_or(StepHistory{}), saved.released);
  if (schedule_.measures(last_.update)) recorded_ = last_.update;
  return last_;
}

void Monitor::begin(const Diagnostics& now, const StepHistory& before,
                    std::optional<double> released) {
  begun_ = true;
  if (scene_.guard) guard_.emplace(scene_, plan_, solver_, first_, now, released);
  if (scene_.time.adaptive) step_.emplace(scene_, before);
}

std::int64_t Monitor::next(std::int64_t u) const {
  const std::int64_t next = goes_back() ? schedule_.next_event(u) : schedule_.next_measure(u);
  return record_gauges_ ? std::min(next, schedule_.next_gauges(u)) : next;
}

Next Monitor::at(Session& session) {
  const std::optional<GaugeRow> row = gauges();
  bool stays = true;
  if (schedule_.measures(session.update()))
    stays = measure(true);
  else if (goes_back() || !row)
    stays = check(diagnose());
  if (row && stays) record_gauges_(*row);
  session.use(options());
  return event_ ? Next::stop : Next::go_on;
}

/// Stopped between two measurements; a state that it went back to is known to be good.
void Monitor::end(Session& session) {
  if (!event_ && recorded_ != session.update()) measure(!goes_back());
}

std::int64_t Monitor::next_choice(std::int64_t u) const {
  return scene_.time.adaptive ? next_multiple(u, schedule_.measure_every) : kNever;
}

Next Monitor::choose(Session& session) {
  timed([&] {
    const int level = step_->level();
    if (const auto change = step_->follow(last_)) apply_level(*change, level);
  });
  session.use(options());
  return Next::go_on;
}

bool Monitor::state_is_good() {
  if (guard_ && !goes_back() && recorded_ != solver_.updates()) check(diagnose());
  return !event_;
}

/// Reads the gauges if they are due, before a state is kept, as for loads.
std::optional<GaugeRow> Monitor::gauges() {
  const std::int64_t u = solver_.updates();
  if (!record_gauges_ || !schedule_.reads_gauges(u)) return std::nullopt;
  const bool regular = u % schedule_.gauge_every == 0;
  return GaugeRow{u, double(u) * scene_.time.step,
                  solver_.readings(Series::gauges, regular ? Interval::ends : Interval::goes_on)};
}

Diagnostics Monitor::diagnose() {
  Diagnostics m = solver_.diagnose();
  m.work = work_.until(m);
  return m;
}

/// Returns whether the measurement stays: false if the session goes back.
bool Monitor::measure(bool checked) {
  Diagnostics m = diagnose();
  // Read them before a state is kept, so that going back does not repeat them. A row between two
  // regular measurements, which a longer run would not have, ends no interval.
  const bool regular = m.update % schedule_.measure_every == 0;
  m.readings = solver_.readings(Series::measures, regular ? Interval::ends : Interval::goes_on);
  const bool first = !begun_;
  if (first) first_ = m, begin(m, {}, {});
  const double dt = std::ldexp(scene_.time.step, -options().level);
  if (checked && !check(m)) return false;
  if (regular) work_.take(m);
  recorded_ = m.update;
  last_ = m;
  record_(last_, dt);
  if (first) first_ = last_;
  return true;
}

/// Returns whether the measurement stays: false if the session goes back.
bool Monitor::check(const Diagnostics& m) {
  bool stays = true;
  if (guard_) timed([&] { stays = verdict(m); });
  return stays;
}

/// If alarms take a run back, its state is kept before any of it is written.
bool Monitor::verdict(const Diagnostics& m) {
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
      apply_level(*change, before);
      return false;
    }
  }
  event_ = guard_->locate(*alarm, m, options());
  return true;
}

/// Records the time of `action`, except that which the solver records itself.
void Monitor::timed(const std::function<void()>& action) {
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

void Monitor::go_back() {
  if (solver_.updates() == guard_->last_good().update) return;
  if (SplitRows* split = solver_.split())
    split->go_back();
  else
    solver_.set_state(solver_.state(StateOf::kept));
}

StepOptions Monitor::options() const {
  StepOptions o = guard_ ? guard_->options() : StepOptions{};
  if (step_) o.level = step_->level();
  return o;
}

std::optional<StepHistory> Monitor::steps(std::optional<std::int64_t> update) const {
  if (!step_) return std::nullopt;
  StepHistory h = step_->history();
  if (update) h.updates = step_->updates_at_levels(*update);
  return h;
}

void Monitor::apply_level(const std::string& change, int level_before) {
  const int finer = step_->level() - level_before;
  note_(change + (finer > 0 ? prestabilize(finer) : std::string()));
}

/// Reduces the compression by 4^levels before shorter steps begin, which would turn it into energy
/// (lib/solver/DIAGNOSTICS.md, "Compression at rest"): first steps without time, then a damping of
/// the velocities that takes away the energy by which these steps lifted the fluid.
std::string Monitor::prestabilize(int levels) {
  constexpr int kMost = 64, kAtOnce = 4;
  constexpr double kHarmless = 1e-3;
  Diagnostics m = diagnose();
  const double compression = m.compression_mean, energy = total_energy(m);
  const double target = std::ldexp(compression, -2 * levels);
  if (std::ldexp(compression, 2 * levels) <= kHarmless) return {};
  int steps = 0;
  for (; steps < kMost && m.compression_mean > target; steps += kAtOnce) {
    solver_.step(kAtOnce, {.without_time = 1.0});
    m = diagnose();
  }
  const double lifted = total_energy(m) - energy;
  if (lifted > 0 && m.kinetic_energy > 0) {
    const double damping = std::sqrt(std::max(0.0, 1 - lifted / m.kinetic_energy));
    solver_.step(1, {.without_time = damping});
    ++steps;
    m = diagnose();
  }
  if (guard_) guard_->keep(m);
  return fmt::format("; mean compression {:.3g} %, {:.3g} % after {} steps without time",
                     100 * compression, 100 * m.compression_mean, steps);
}

}  // namespace pbf::run_module
