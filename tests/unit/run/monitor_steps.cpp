// The step that a monitor chooses, with a solver that only counts.
#include <cmath>

#include "lib/run/monitor.h"
#include "tests/support/catch.h"
#include "tests/support/watched_session.h"

namespace pbf::scene_test {

TEST_CASE("monitor: a new step is chosen behind what needs the state as it was measured") {
  WatchedSession s(with_shorter_steps());
  // 0.8 h in an update from 4 on. Compressed by 10 %, half of it after each 4 steps without time,
  // which lift the fluid by 1 J.
  s.solver.flow = [&](Diagnostics& m) {
    m.kinetic_energy = s.solver.steps_without_time() > 8 ? 2 : 4;
    if (m.update < 4) return;
    m.speed_max = 16;
    m.potential_energy = double(s.solver.steps_without_time() / 4);
    m.compression_mean = 0.1 * std::exp2(-double(s.solver.steps_without_time() / 4));
  };
  const auto at_4 = [&](std::int64_t without_time) {
    return [&s, without_time](Session& session) {
      if (session.update() == 4) CHECK(s.solver.steps_without_time() == without_time);
      return Next::go_on;
    };
  };
  s.frames.then = at_4(0);
  s.behind.then = at_4(9);
  s.run();
  CHECK(s.calls().at(1) == std::array<std::int64_t, 3>{3, 4, 0});
  CHECK(s.calls().at(2) == std::array<std::int64_t, 3>{4, 6, 1});
  REQUIRE(s.notes.size() == 1);
  CHECK(contains(s.notes[0], "update 4, 0.04 s: step 0.005 s (was 0.01)"));
  CHECK(contains(s.notes[0], "; mean compression 10 %, 2.5 % after 9 steps without time"));
  // To a quarter of the compression in two calls; the third takes 2 J from the motion's 4.
  std::vector<std::pair<int, double>> without_time;
  for (const auto& c : s.solver.calls)
    if (c.options.without_time) without_time.emplace_back(c.updates, *c.options.without_time);
  REQUIRE(without_time.size() == 3);
  CHECK(without_time[0] == std::pair(4, 1.0));
  CHECK(without_time[1] == std::pair(4, 1.0));
  CHECK(without_time[2].first == 1);
  CHECK(without_time[2].second == Approx(std::sqrt(0.5)));
}

TEST_CASE("monitor: the state relieved for a shorter step is the one to go back to") {
  WatchedSession s(with_shorter_steps());
  s.solver.flow = [&](Diagnostics& m) {
    if (m.update == 4) m.speed_max = 16;
    if (m.update == 4) m.compression_mean = s.solver.steps_without_time() > 0 ? 1e-5 : 0.1;
    m.non_finite = m.update == 6 && s.monitor.options().level == 1;
  };
  s.run();
  CHECK(s.monitor.steps()->repeats == 1);
  int reliefs = 0;
  for (const auto& c : s.solver.calls) reliefs += c.options.without_time.has_value();
  CHECK(reliefs == 1);
  CHECK(s.updates() == UpdateNumbers{0, 4, 8, 10});
}

TEST_CASE("monitor: a measure at the end of a run alone chooses no step") {
  WatchedSession s(with_shorter_steps());
  s.solver.flow = [](Diagnostics& m) { m.speed_max = m.update == 10 ? 16 : 0; };
  s.run();
  CHECK(s.monitor.options().level == 0);
  CHECK(s.notes.empty());
}

}  // namespace pbf::scene_test
