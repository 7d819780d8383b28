// What follows from a measure of a run: whether it goes on (guard), and with which step
// (time.adaptive).
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lib/run/guard.h"
#include "lib/run/step_control.h"

namespace pbf::inline run_module {

/// good: the run goes on. back: the solver has gone back to the last good state, and repeats the
/// updates since with half the step. stop: the guard ends the run; the solver has gone back, too.
enum class Verdict { good, back, stop };

class Watch {
 public:
  /// `first`: the measure that the run began with, `now`: that of the present state; `before`: what
  /// a checkpoint remembers, and `released` what it does of Guard::released(). `note` gets a line
  /// for every change of the step.
  Watch(const Scene& scene, const Plan& plan, Solver& solver, const Measures& first,
        const Measures& now, std::function<void(const std::string&)> note,
        const StepHistory& before = {}, std::optional<double> released = {});

  /// Judges a measure. `keep`: its state, if good, is the one to go back to; where alarms take a
  /// run back, that must come before anything of the state is written down.
  Verdict look(const Measures& m, bool keep = true);

  /// After a good measure of the scene's measure_every, and no other: chooses the step of the
  /// updates to come.
  void choose(const Measures& m);

  /// Whether an alarm may take the run back. Then a checkpoint holds the last good state, not the
  /// present one: what happens after it does not depend on when it was written.
  bool goes_back() const { return guard_ && step_; }
  /// Takes the solver back to the last good state, where it is not there already.
  void go_back();

  double step() const;  ///< s, at present
  /// What the solver's updates are to be made with.
  StepOptions options() const;
  /// Null without guard, or time.adaptive.
  const Guard* guard() const { return guard_ ? &*guard_ : nullptr; }
  const AdaptiveStep* adaptive() const { return step_ ? &*step_ : nullptr; }
  const std::optional<GuardEvent>& event() const { return event_; }  ///< after `stop`

 private:
  void take(const std::string& change, int level_before);
  std::string relax(int levels);

  double whole_;  ///< s, time.step
  Solver& solver_;
  std::function<void(const std::string&)> note_;
  std::optional<Guard> guard_;
  std::optional<AdaptiveStep> step_;
  std::optional<GuardEvent> event_;
};

}  // namespace pbf::inline run_module
