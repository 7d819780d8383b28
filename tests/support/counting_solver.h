// A solver without physics: it counts, and a test says what it measures. And observers that only
// remember.
#pragma once

#include <functional>
#include <future>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "lib/program/schedule.h"
#include "lib/run/session.h"
#include "tests/support/catch.h"

namespace pbf::test {

/// Two particles, or those of `ids`, at (steps, steps without time, id): a state tells how it came
/// about. A load and a gauge read the updates since they were read last.
class CountingSolver : public Solver, public Inspection {
 public:
  static constexpr std::size_t particles = 2;
  static constexpr double time_step = 0.01;  ///< s
  struct Call {
    std::int64_t from;
    int updates;
    StepOptions options;
  };
  std::vector<Call> calls;
  std::vector<std::int64_t> measured;  ///< updates
  double seconds = 0;                  ///< that an update takes
  /// Completes a measure, of which update and time are there.
  std::function<void(Diagnostics&)> flow = [](Diagnostics&) {};
  std::function<void()> before_state = [] {};  ///< is called where a state is asked for
  std::int64_t fault = -1;                     ///< the update that step_checked() finds it in
  /// The particles after an update, where they appear and disappear. Their ids then have 64 bits.
  std::function<std::vector<std::int64_t>(std::int64_t update)> ids{};
  std::size_t measures = 1;  ///< numbers of that series; all behind the first are 0

  std::int64_t steps() const { return now_.steps; }
  std::int64_t steps_without_time() const { return now_.without_time; }
  std::int64_t kept() const { return kept_.updates; }

  void step(int n, const StepOptions& options) override {
    calls.push_back({now_.updates, n, options});
    for (const Stopwatch watch; watch.seconds() < n * seconds;) continue;
    if (options.without_time) return void(now_.without_time += n);
    now_.updates += n;
    now_.steps += std::int64_t(n) << options.level;
    now_.load += n;
    now_.gauge += n;
  }
  SolverState state(StateOf which) override {
    before_state();
    const Counts& c = which == StateOf::kept ? kept_ : now_;
    SolverState s;
    s.updates = c.updates;
    s.steps = c.steps;
    s.fields = {{"sums", false, 3, {double(c.without_time), double(c.load), double(c.gauge)}}};
    s.id = particles_after(c.updates);
    for (const std::int64_t id : s.id)
      s.position.insert(s.position.end(), {double(c.steps), double(c.without_time), double(id)});
    s.velocity.resize(3 * s.id.size());
    return s;
  }
  void set_state(const SolverState& s) override {
    if (ids) CHECK(s.id == ids(s.updates));
    const StoredField* stored = s.find("sums");
    const std::vector<double> sums = stored ? stored->values : std::vector<double>(3);
    now_ = {s.updates, s.steps, std::int64_t(sums[0]), std::int64_t(sums[1]),
            std::int64_t(sums[2])};
  }
  void keep() override { kept_ = now_; }
  std::int64_t updates() const override { return now_.updates; }
  std::future<Snapshot> download(const std::vector<std::string>& fields, ScalarType) override {
    REQUIRE_FALSE(std::exchange(copying_, true));  // one at a time
    const std::vector<std::int64_t> now = particles_after(now_.updates);
    Snapshot s{now_.updates, double(now_.updates) * time_step, now.size(), {}};
    std::vector<std::string> names{"position"};
    names.insert(names.end(), fields.begin(), fields.end());
    for (const std::string& name : names) {
      const int components = name == "density" ? 1 : 3;
      FieldArray f{name, "1", ScalarType::f32, components, {}};
      f.bytes.resize(4 * s.count * std::size_t(components));
      for (std::size_t k = 0; name == "position" && k < s.count; ++k) {
        f.as<float>()[3 * k] = float(now_.steps);
        f.as<float>()[3 * k + 1] = float(now_.without_time);
        f.as<float>()[3 * k + 2] = float(now[k]);
      }
      s.fields.push_back(std::move(f));
    }
    const ScalarType whole = ids ? ScalarType::i64 : ScalarType::i32;
    FieldArray id{"id", "1", whole, 1, std::vector<std::byte>(size_of(whole) * s.count)};
    for (std::size_t k = 0; k < s.count; ++k)
      ids ? id.as<std::int64_t>()[k] = now[k] : id.as<std::int32_t>()[k] = std::int32_t(now[k]);
    s.fields.push_back(std::move(id));
    return std::async(std::launch::deferred, [this, s = std::move(s)]() mutable {
      copying_ = false;
      return std::move(s);
    });
  }
  Diagnostics diagnose() override {
    measured.push_back(now_.updates);
    Diagnostics m;
    m.update = now_.updates;
    m.time = double(now_.updates) * time_step;
    flow(m);
    return m;
  }
  std::vector<double> readings(Series series, Interval interval) override {
    std::vector<double> all(series == Series::gauges ? 1 : measures);
    all[0] = read(series == Series::gauges ? now_.gauge : now_.load, interval);
    return all;
  }
  SolverInfo info() const override { return {}; }

  Inspection* inspection() override { return this; }
  StepTrace trace(const TraceOptions&) override { return {}; }
  std::optional<StageEvent> step_checked(const StageLimits&, const StepOptions& options) override {
    step(1, options);
    if (now_.updates != fault) return std::nullopt;
    return StageEvent{Alarm::non_finite, fault, "delta", "", 1, 0, {}, {}, 0};
  }
  void inject(const Fault&) override {}

 private:
  struct Counts {
    std::int64_t updates = 0, steps = 0, without_time = 0, load = 0, gauge = 0;
  };
  static double read(std::int64_t& count, Interval interval) {
    return double(interval == Interval::ends ? std::exchange(count, 0) : count);
  }
  std::vector<std::int64_t> particles_after(std::int64_t update) const {
    if (ids) return ids(update);
    std::vector<std::int64_t> all(particles);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  Counts now_, kept_;
  bool copying_ = false;
};

using Told = std::vector<std::string>;
using UpdateNumbers = std::vector<std::int64_t>;

/// Wants every multiple of `every`; kEveryCall and kAlways stand for themselves.
class Recorder : public Observer {
 public:
  Recorder(std::string name, std::int64_t every, Told& told)
      : name_(std::move(name)), every_(every), told_(told) {}
  std::function<Next(Session&)> then = [](Session&) { return Next::go_on; };
  UpdateNumbers seen;

  std::int64_t next(std::int64_t u) const override {
    return every_ > 0 ? next_multiple(u, every_) : every_;
  }
  Next at(Session& session) override {
    seen.push_back(session.update());
    told_.push_back(name_ + " " + std::to_string(session.update()));
    return then(session);
  }
  void end(Session& session) override {
    told_.push_back(name_ + " ends " + std::to_string(session.update()));
  }
  void close() noexcept override { told_.push_back(name_ + " closes"); }

 private:
  std::string name_;
  std::int64_t every_;
  Told& told_;
};

}  // namespace pbf::test
