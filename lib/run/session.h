// The only loop over the updates of a simulation. Observers do all work between updates.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "lib/solver/solver.h"

namespace pbf::inline run_module {

class Session;

/// What an observer makes of the session.
enum class Now { go_on, stop };

/// Answers of Observer::next() that are no update.
inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
inline constexpr std::int64_t kEveryCall = -1;  ///< after every call of Solver::step()
inline constexpr std::int64_t kAlways = -2;     ///< then, and before the first one

/// Whoever has something to do between updates. May throw.
class Observer {
 public:
  virtual ~Observer() = default;
  /// When next: the first update after `u` (-1: the start is to come) at which at() is wanted.
  virtual std::int64_t next(std::int64_t u) const = 0;
  /// What now, at Session::update(). To go back it gives the solver an earlier state: the updates
  /// since come again, and the observers behind it that wanted the later one are not called. Where
  /// one stops the session, none behind it is called.
  virtual Now at(Session& session) = 0;
  /// Once, after the last update.
  virtual void end(Session& /*session*/) {}
  /// Last of all, also where something was thrown.
  virtual void close() noexcept {}
};

/// An observer made of two functions.
class Callback : public Observer {
 public:
  Callback(std::function<std::int64_t(std::int64_t)> next, std::function<Now(Session&)> at)
      : next_(std::move(next)), at_(std::move(at)) {}
  std::int64_t next(std::int64_t u) const override { return next_(u); }
  Now at(Session& session) override { return at_(session); }

 private:
  std::function<std::int64_t(std::int64_t)> next_;
  std::function<Now(Session&)> at_;
};

/// s, within Solver::step(); cpu: of all threads of this process.
struct StepSeconds {
  double wall = 0, cpu = 0;
};

class Session {
 public:
  /// A call of Solver::step() takes `longest_call` s at most, or one update: so long may a signal
  /// have to wait. Without observers that need more, a call goes on to the next update that is
  /// asked for. Observers are called in their order, and must live as long as this.
  explicit Session(Solver& solver, std::vector<Observer*> observers = {},
                   double longest_call = std::numeric_limits<double>::max())
      : solver_(solver), observers_(std::move(observers)), longest_call_(longest_call) {}

  /// Runs until update `end` or until an observer stops it. What was due until update `seen` is not
  /// done again: the update of a state that a run goes on from, -1 for a run from its start.
  void run(std::int64_t end, std::int64_t seen = -1);

  Solver& solver() const { return solver_; }
  std::int64_t update() const { return solver_.updates(); }
  const StepSeconds& seconds() const { return seconds_; }
  /// How the updates to come are made.
  void use(const StepOptions& options);

 private:
  void ask(std::int64_t u);
  bool tell();
  void step(std::int64_t end);

  Solver& solver_;
  std::vector<Observer*> observers_;
  std::vector<std::int64_t> next_;        ///< of each observer
  double longest_call_, per_update_ = 1;  ///< s; the latter of the last call
  StepSeconds seconds_;
  StepOptions options_;
};

/// `updates` more without observers.
inline void advance(Solver& solver, std::int64_t updates) {
  Session(solver).run(solver.updates() + updates);
}

}  // namespace pbf::inline run_module
