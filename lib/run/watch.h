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

namespace pbf::inline run_module {

/// Diagnostics where it is due. Where the guard objects, the session goes back to the last good
/// state and repeats the updates since with half the step, or it ends; the solver has gone back,
/// too.
class Watch : public Observer {
 public:
  /// Gets every measure but those that the session goes back from; dt: of the steps before, s.
  using Take = std::function<void(Diagnostics& m, double dt)>;
  /// `note` gets a line for every change of the step, `clock` what the guard takes, as "guard".
  Watch(
      const Scene& scene, const Plan& plan, Solver& solver, Take take,
      std::function<void(const std::string&)> note = [](const std::string&) {},
      StageClock* clock = nullptr);
  /// `take` gets every reading of the gauges but those that the session goes back from.
  void read_gauges(std::function<void(const GaugeRow&)> take) { take_gauges_ = std::move(take); }
  /// Before the session: the solver has the state already. last() is its measure, to be completed.
  Diagnostics& go_on_from(const SavedRun& saved);

  std::int64_t next(std::int64_t u) const override;
  Now at(Session& session) override;
  void end(Session& session) override;
  /// Chooses the step of the updates to come, behind the observers that need the state as it was
  /// measured. A measure at the end of a run alone chooses nothing: a longer run would not have it.
  Observer& choosing() { return choosing_; }

  /// Whether the guard leaves the state of a run that has no way back as it is; measured if need
  /// be.
  bool state_is_good();
  /// Whether an alarm may take the run back. Then a checkpoint holds the last good state, not the
  /// present one: what happens after it does not depend on when it was written.
  bool goes_back() const { return guard_ && step_; }
  /// Takes the solver back to the last good state, where it is not there already.
  void go_back();

  /// What the session's updates are to be made with; it is told when they change.
  StepOptions options() const;
  /// Null without guard, and before the first measure.
  const Guard* guard() const { return guard_ ? &*guard_ : nullptr; }
  /// With time.adaptive: what was chosen; its `updates` up to `update`, or as a checkpoint has
  /// them.
  std::optional<StepHistory> steps(std::optional<std::int64_t> update = {}) const;
  /// What the guard stopped the session for; null unless it did.
  const GuardEvent* event() const { return event_ ? &*event_ : nullptr; }
  const Diagnostics& first() const { return first_; }
  const Diagnostics& last() const { return last_; }

 private:
  std::int64_t next_choice(std::int64_t u) const;
  Now choose(Session& session);
  void begin(const Diagnostics& now, const StepHistory& before, std::optional<double> released);
  Diagnostics measured();
  bool measure(bool judged);
  std::optional<GaugeRow> gauges();
  bool look(const Diagnostics& m);
  bool judge(const Diagnostics& m);
  void take(const std::string& change, int level_before);
  std::string prestabilize(int levels);
  void booked(const std::function<void()>& action);

  const Scene& scene_;
  const Plan& plan_;
  Solver& solver_;
  Take take_;
  std::function<void(const std::string&)> note_;
  std::function<void(const GaugeRow&)> take_gauges_;
  StageClock* clock_;
  Schedule schedule_;
  Callback choosing_{[this](std::int64_t u) { return next_choice(u); },
                     [this](Session& session) { return choose(session); }};
  std::optional<Guard> guard_;
  std::optional<AdaptiveStep> step_;
  std::optional<GuardEvent> event_;
  Diagnostics first_, last_;
  WorkTrack work_;
  std::int64_t taken_ = -1;  // update of the last measure that was taken
  bool begun_ = false;
};

}  // namespace pbf::inline run_module
