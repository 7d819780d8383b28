// A monitor in a session, with a solver that only counts.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lib/run/monitor.h"
#include "tests/support/counting_solver.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {

using test::CountingSolver;
using test::Recorder;
using test::Told;
using test::UpdateNumbers;

/// Ten updates, measured every 4, with frames every 3 and gauges read every `gauges`.
inline Scene ten_updates(int gauges = 100) {
  Scene s = parse(kMinimal +
                      "gauges: [{name: l, kind: level, at: [0.5, 0.5]}]\noutput: {every: 0.03, "
                      "gauges_every: " +
                      std::to_string(0.01 * gauges) + "}\n",
                  {"time.end=0.1", "measure_every=4"});
  s.guard.reset();
  return s;
}
inline Scene with_guard(Scene s = ten_updates()) {
  s.guard.emplace();
  return s;
}
/// At most four times as fine.
inline Scene with_shorter_steps(Scene s = with_guard()) {
  s.time.adaptive.emplace().step_min = s.time.step / 4;
  return s;
}

/// A monitor in a session, between observers that only remember.
struct WatchedSession {
  Scene scene;
  Plan plan = make_plan(scene, CountingSolver::particles);
  CountingSolver solver{};
  Told told{};
  std::vector<Diagnostics> taken{};
  std::vector<double> steps{};  ///< s, given with the measures
  std::vector<GaugeRow> readings{};
  std::vector<std::string> notes{};
  Monitor monitor{scene, plan, solver,
                  [this](Diagnostics& m, double dt) { taken.push_back(m), steps.push_back(dt); },
                  [this](const std::string& note) { notes.push_back(note); }};
  Recorder before{"before", kEveryCall, told}, frames{"frames", 3, told},
      behind{"behind", kEveryCall, told};

  explicit WatchedSession(const Scene& s) : scene(s) {
    monitor.read_gauges([this](const GaugeRow& row) { readings.push_back(row); });
  }
  void run(std::int64_t end = 10, std::int64_t seen = -1) {
    Session session(solver, {&before, &monitor, &frames, &monitor.choosing(), &behind});
    session.use(monitor.options());
    session.run(end, seen);
  }
  UpdateNumbers updates() const {
    UpdateNumbers out;
    for (const Diagnostics& m : taken) out.push_back(m.update);
    return out;
  }
  /// UpdateNumbers since the load was taken before, of each measure.
  UpdateNumbers loads() const {
    UpdateNumbers out;
    for (const Diagnostics& m : taken) out.push_back(std::int64_t(m.readings.at(0)));
    return out;
  }
  /// Of each call with time: from, to, level.
  std::vector<std::array<std::int64_t, 3>> calls() const {
    std::vector<std::array<std::int64_t, 3>> out;
    for (const auto& c : solver.calls)
      if (!c.options.without_time)
        out.push_back({c.from, c.from + c.updates, std::int64_t(c.options.level)});
    return out;
  }
};

/// Update `at` is wrong where no update before it had a shorter step.
inline auto wrong_at(const CountingSolver& solver, std::int64_t at) {
  return [&solver, at](Diagnostics& m) { m.non_finite = m.update == at && solver.steps() == at; };
}

}  // namespace pbf::scene_test
