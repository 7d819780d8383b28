#include "lib/run/session.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "lib/base/stage_clock.h"

namespace pbf::run_module {

void Session::run(std::int64_t end, std::int64_t seen) {
  struct Closing {
    const std::vector<Observer*>& observers;
    ~Closing() {
      for (Observer* o : observers) o->close();
    }
  } closing{observers_};
  ask(seen);
  std::ranges::replace(next_, kEveryCall, kNever);
  while (notify_observers() && update() < end) {
    ask(update());
    step(end);
  }
  for (Observer* o : observers_) o->end(*this);
}

void Session::use(const StepOptions& options) {
  per_update_ = std::ldexp(per_update_, options.level - options_.level);
  options_ = options;
}

void Session::ask(std::int64_t u) {
  next_.clear();
  for (const Observer* o : observers_) next_.push_back(o->next(u));
}

/// Returns whether the session continues.
bool Session::notify_observers() {
  for (std::size_t k = 0; k < observers_.size(); ++k)
    if (next_[k] <= update() && observers_[k]->at(*this) == Next::stop) return false;
  return true;
}

void Session::step(std::int64_t end) {
  const std::int64_t u = update();
  for (const std::int64_t next : next_)
    if (next > u) end = std::min(end, next);
  // Few calls if an update takes microseconds; the first call measures this.
  const double most = std::clamp(longest_call_ / per_update_, 1.0, double(1 << 20));
  const int n = int(std::min(end - u, std::int64_t(most)));
  const Stopwatch watch;
  const std::clock_t cpu = std::clock();
  solver_.step(n, options_);
  const double wall = watch.seconds();
  seconds_.cpu += double(std::clock() - cpu) / CLOCKS_PER_SEC;
  seconds_.wall += wall;
  per_update_ = wall / n;
}

}  // namespace pbf::run_module
