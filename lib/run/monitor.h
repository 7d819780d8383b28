// The measurements of a session, and the decisions that follow from them: whether the run continues
// (guard), and with which time step (time.adaptive).
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lib/base/stage_clock.h"
#include "lib/io/checkpoint.h"
#include "lib/io/run_file.h"
#include "lib/program/schedule.h"
#include "lib/run/guard.h"
#include "lib/run/session.h"
#include "lib/run/step_control.h"

namespace pbf::run_module {

/// Measures when it is due. If the guard raises an alarm, the session goes back to the last good
/// state and repeats the updates with half the step, or it ends; then the solver has gone back,
/// too.
class Monitor : public Observer {
 public:
  /// Gets every measurement except those from which the session goes back; dt: preceding step, s.
  using Record = std::function<void(Diagnostics& m, double dt)>;
  /// `note` gets a line per change of the step; `clock` gets the time of the guard, as "guard".
  Monitor(
      const Scene& scene, const Plan& plan, Solver& solver, Record record,
      std::function<void(const std::string&)> note = [](const std::string&) {},
      StageClock* clock = nullptr);
  /// `record` gets every gauge reading except those from which the session goes back.
  void read_gauges(std::function<void(const GaugeRow&)> record) {
    record_gauges_ = std::move(record);
  }
  /// Call before the session, with the state in the solver. Returns last(), to be completed.
  Diagnostics& go_on_from(const SavedRun& saved);

  std::int64_t next(std::int64_t u) const override;
  Next at(Session& session) override;
  void end(Session& session) override;
  /// Chooses the step of the following updates, after the observers that need the measured state. A
  /// measurement only for the end of a run chooses nothing: a longer run would lack it.
  Observer& choosing() { return choosing_; }

  /// Whether the guard accepts the present state, in a run that cannot go back; measures if
  /// necessary.
  bool state_is_good();
  /// Whether an alarm may take the run back. Then a checkpoint holds the last good state, not the
  /// present one, so that the results do not depend on when it was written.
  bool goes_back() const { return guard_ && step_; }
  /// Takes the solver back to the last good state, unless it is there.
  void go_back();

  /// Options for the session's updates; the session is told when they change.
  StepOptions options() const;
  /// Null without guard, and before the first measurement.
  const Guard* guard() const { return guard_ ? &*guard_ : nullptr; }
  /// With time.adaptive: the history of the step, with `updates` counted up to `update`, or as
  /// stored in a checkpoint.
  std::optional<StepHistory> steps(std::optional<std::int64_t> update = {}) const;
  /// The event for which the guard stopped the session; null if it did not.
  const GuardEvent* event() const { return event_ ? &*event_ : nullptr; }
  const Diagnostics& first() const { return first_; }
  const Diagnostics& last() const { return last_; }

 private:
  std::int64_t next_choice(std::int64_t u) const;
  Next choose(Session& session);
  void begin(const Diagnostics& now, const StepHistory& before, std::optional<double> released);
  Diagnostics diagnose();
  bool measure(bool checked);
  std::optional<GaugeRow> gauges();
  bool check(const Diagnostics& m);
  bool verdict(const Diagnostics& m);
  void apply_level(const std::string& change, int level_before);
  std::string prestabilize(int levels);
  void timed(const std::function<void()>& action);

  const Scene& scene_;
  const Plan& plan_;
  Solver& solver_;
  Record record_;
  std::function<void(const std::string&)> note_;
  std::function<void(const GaugeRow&)> record_gauges_;
  StageClock* clock_;
  Schedule schedule_;
  Callback choosing_{[this](std::int64_t u) { return next_choice(u); },
                     [this](Session& session) { return choose(session); }};
  std::optional<Guard> guard_;
  std::optional<AdaptiveStep> step_;
  std::optional<GuardEvent> event_;
  Diagnostics first_, last_;
  WorkTrack work_;
  std::int64_t recorded_ = -1;  // update of the last recorded measurement
  bool begun_ = false;
};

}  // namespace pbf::run_module
