// The only loop over the updates of a simulation. Observers do all work between updates.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "lib/solver/solver.h"

namespace pbf::run_module {

class Session;

/// An observer's decision about the session.
enum class Next { go_on, stop };

/// Special values of Observer::next().
inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
inline constexpr std::int64_t kEveryCall = -1;  ///< after every call of Solver::step()
inline constexpr std::int64_t kAlways = -2;     ///< the same, and before the first call

/// Does work between updates. Functions may throw.
class Observer {
 public:
  virtual ~Observer() = default;
  /// The first update after `u` at which at() is wanted; u = -1: before the start.
  virtual std::int64_t next(std::int64_t u) const = 0;
  /// Called at Session::update(). May give the solver an earlier state: the updates since then are
  /// repeated, and the later observers of the list are not called if they wanted the later update.
  /// If an observer stops the session, later observers are not called.
  virtual Next at(Session& session) = 0;
  /// Called once, after the last update.
  virtual void end(Session& /*session*/) {}
  /// Called last in all cases, also after an exception.
  virtual void close() noexcept {}
};

/// An observer made of two functions.
class Callback : public Observer {
 public:
  Callback(std::function<std::int64_t(std::int64_t)> next, std::function<Next(Session&)> at)
      : next_(std::move(next)), at_(std::move(at)) {}
  std::int64_t next(std::int64_t u) const override { return next_(u); }
  Next at(Session& session) override { return at_(session); }

 private:
  std::function<std::int64_t(std::int64_t)> next_;
  std::function<Next(Session&)> at_;
};

/// Seconds in Solver::step(); cpu: of all threads of this process.
struct StepSeconds {
  double wall = 0, cpu = 0;
};

class Session {
 public:
  /// A call of Solver::step() takes at most about `longest_call` s, or one update; a signal waits
  /// this long. Otherwise a call runs to the next update that an observer wants. Observers are
  /// called in the order of the list and must outlive this object.
  explicit Session(Solver& solver, std::vector<Observer*> observers = {},
                   double longest_call = std::numeric_limits<double>::max())
      : solver_(solver), observers_(std::move(observers)), longest_call_(longest_call) {}

  /// Runs until update `end` or until an observer stops it. Work due up to update `seen` is not
  /// repeated: the update of a resumed state, -1 for a run from its start.
  void run(std::int64_t end, std::int64_t seen = -1);

  Solver& solver() const { return solver_; }
  std::int64_t update() const { return solver_.updates(); }
  const StepSeconds& seconds() const { return seconds_; }
  /// Sets the options of the following updates.
  void use(const StepOptions& options);

 private:
  void ask(std::int64_t u);
  bool notify_observers();
  void step(std::int64_t end);

  Solver& solver_;
  std::vector<Observer*> observers_;
  std::vector<std::int64_t> next_;        ///< per observer
  double longest_call_, per_update_ = 1;  ///< s; the second is measured in the last call
  StepSeconds seconds_;
  StepOptions options_;
};

/// Makes `updates` updates without observers.
inline void advance(Solver& solver, std::int64_t updates) {
  Session(solver).run(solver.updates() + updates);
}

}  // namespace pbf::run_module
