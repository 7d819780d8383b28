// What a session measures, and what an alarm does to it, with a solver that only counts.
#include "lib/run/monitor.h"

#include "tests/support/catch.h"
#include "tests/support/watched_session.h"

namespace pbf::scene_test {
namespace {

/// The readings as pairs of update and number.
std::vector<std::pair<std::int64_t, double>> pairs(const std::vector<GaugeRow>& rows) {
  std::vector<std::pair<std::int64_t, double>> out;
  for (const GaugeRow& row : rows) out.emplace_back(row.update, row.numbers.at(0));
  return out;
}
using Readings = std::vector<std::pair<std::int64_t, double>>;

}  // namespace

TEST_CASE("monitor: a measure at every multiple of measure_every and at the end, each once") {
  WatchedSession s(ten_updates());
  s.run();
  CHECK(s.updates() == UpdateNumbers{0, 4, 8, 10});
  CHECK(s.steps == std::vector<double>(4, 0.01));
  CHECK(s.loads() == UpdateNumbers{0, 4, 4, 2});
  CHECK(s.monitor.first().update == 0);
  CHECK(s.monitor.last().update == 10);
  // The load at the end ends no interval: a run that goes on counts it once more.
  CHECK(s.solver.readings(Series::measures, Interval::goes_on).at(0) == 2);
  // Without a guard nothing is measured but that, and no state is kept.
  CHECK(s.solver.measured == UpdateNumbers{0, 4, 8, 10});
  CHECK(s.solver.kept() == 0);
  CHECK(s.monitor.options() == StepOptions{});
}

TEST_CASE("monitor: a run that is stopped between two measures has one more, with a load so far") {
  WatchedSession s(ten_updates());
  s.behind.then = [](Session& session) { return session.update() == 6 ? Next::stop : Next::go_on; };
  s.run();
  CHECK(s.updates() == UpdateNumbers{0, 4, 6});
  CHECK(s.loads() == UpdateNumbers{0, 4, 2});
  CHECK(s.solver.readings(Series::measures, Interval::goes_on).at(0) == 2);
  WatchedSession at_a_measure(ten_updates());
  at_a_measure.behind.then = [](Session& session) {
    return session.update() == 4 ? Next::stop : Next::go_on;
  };
  at_a_measure.run();
  CHECK(at_a_measure.updates() == UpdateNumbers{0, 4});
}

TEST_CASE("monitor: an alarm ends a run without shorter steps at the update at fault") {
  WatchedSession s(with_guard());
  s.solver.flow = wrong_at(s.solver, 8);
  s.solver.fault = 5;
  s.run();
  REQUIRE(s.monitor.event());
  CHECK(s.monitor.event()->alarm == Alarm::non_finite);
  CHECK(s.monitor.event()->measure.update == 8);
  CHECK(s.monitor.event()->stage->update == 5);
  CHECK(s.monitor.event()->last_good.updates == 4);
  // The measure that shows it stands in the log; nothing behind the monitor is called any more.
  CHECK(s.updates() == UpdateNumbers{0, 4, 8});
  CHECK(s.frames.seen == UpdateNumbers{0, 3, 6});
  CHECK(s.solver.updates() == 5);
  const Told end{s.told.end() - 7, s.told.end()};
  CHECK(end == Told{"before 8", "before ends 5", "frames ends 5", "behind ends 5", "before closes",
                    "frames closes", "behind closes"});
  CHECK_FALSE(s.monitor.goes_back());
}

TEST_CASE("monitor: a guard keeps the state of every good measure") {
  WatchedSession s(with_guard());
  s.run();
  CHECK(s.solver.kept() == 10);
  CHECK(s.monitor.guard()->last_good().update == 10);
  CHECK_FALSE(s.monitor.event());
}

TEST_CASE("monitor: an alarm repeats the updates since the last good state with half the step") {
  WatchedSession s(with_shorter_steps());
  s.solver.flow = wrong_at(s.solver, 8);
  s.run();
  CHECK_FALSE(s.monitor.event());
  // States are kept where a measure or a frame is due: the last one before is that of frame 6.
  CHECK(s.calls() ==
        std::vector<std::array<std::int64_t, 3>>{
            {0, 3, 0}, {3, 4, 0}, {4, 6, 0}, {6, 8, 0}, {6, 8, 1}, {8, 9, 1}, {9, 10, 1}});
  REQUIRE(s.notes.size() == 1);
  CHECK(
      contains(s.notes[0], "update 8, 0.08 s: alarm of the guard (non_finite), back to update 6"));
  CHECK_FALSE(contains(s.notes[0], "without time"));  // nothing is compressed
  // Nobody behind the monitor gets what was taken back, nor anything twice.
  CHECK(s.updates() == UpdateNumbers{0, 4, 8, 10});
  CHECK(s.steps == std::vector<double>{0.01, 0.01, 0.005, 0.005});
  CHECK(s.frames.seen == UpdateNumbers{0, 3, 6, 9});
  CHECK(s.before.seen == UpdateNumbers{3, 4, 6, 8, 8, 9, 10});
  CHECK(s.behind.seen == UpdateNumbers{3, 4, 6, 6, 8, 9, 10});
  CHECK(s.solver.steps() == 6 + 2 * 4);
  CHECK(s.monitor.steps()->repeats == 1);
  CHECK(s.monitor.steps(10)->updates == UpdateNumbers{6, 4, 0});
  // A load does not count twice what was done twice.
  CHECK(s.loads() == UpdateNumbers{0, 4, 4, 2});
  // The end of this run is none of a longer one: no state is kept for it.
  CHECK(s.solver.kept() == 9);
}

TEST_CASE("monitor: what is wrong at a frame is taken back before anybody has seen the frame") {
  WatchedSession s(with_shorter_steps());
  s.solver.flow = wrong_at(s.solver, 6);
  s.frames.then = [&](Session& session) {
    if (session.update() == 6) CHECK(s.solver.steps() == 4 + 2 * 2);
    return Next::go_on;
  };
  s.run();
  CHECK(s.frames.seen == UpdateNumbers{0, 3, 6, 9});
  CHECK(s.monitor.steps(10)->updates == UpdateNumbers{4, 6, 0});
  CHECK(s.updates() == UpdateNumbers{0, 4, 8, 10});
}

TEST_CASE("monitor: with the finest step an alarm ends the run, and no step was tried twice") {
  WatchedSession s(with_shorter_steps());
  s.solver.flow = [](Diagnostics& m) { m.non_finite = m.update == 8; };
  s.solver.fault = 7;
  s.run();
  REQUIRE(s.monitor.event());
  CHECK(s.monitor.event()->last_good.updates == 6);
  CHECK(s.solver.updates() == 7);
  CHECK(s.notes.size() == 2);
  CHECK(s.monitor.steps()->repeats == 2);
  CHECK(s.updates() == UpdateNumbers{0, 4, 8});
  CHECK(s.frames.seen == UpdateNumbers{0, 3, 6});
  // From frame 6: with each of the three steps, and once more stage by stage with the finest.
  std::vector<int> levels;
  for (const auto& c : s.calls())
    if (c[0] == 6) levels.push_back(int(c[2]));
  CHECK(levels == std::vector<int>{0, 1, 2, 2});
}

TEST_CASE("monitor: readings of gauges that are taken back come once, over their whole interval") {
  for (const std::int64_t wrong : {6, 8}) {
    CAPTURE(wrong);
    WatchedSession s(with_shorter_steps(with_guard(ten_updates(2))));
    s.solver.flow = wrong_at(s.solver, wrong);
    s.run();
    CHECK(s.monitor.steps()->repeats == 1);
    CHECK(pairs(s.readings) == Readings{{0, 0}, {2, 2}, {4, 2}, {6, 2}, {8, 2}, {10, 2}});
  }
  // The interval does not divide the run: what is read at the end goes on.
  WatchedSession s(ten_updates(4));
  s.run();
  CHECK(pairs(s.readings) == Readings{{0, 0}, {4, 4}, {8, 4}, {10, 2}});
  CHECK(s.readings[2].time == Approx(0.08));
  CHECK(s.solver.readings(Series::gauges, Interval::goes_on).at(0) == 2);
}

TEST_CASE("monitor: a run that goes on repeats no measure, and knows its start and its step") {
  const std::int64_t from = GENERATE(6, 8);
  CAPTURE(from);
  WatchedSession s(with_shorter_steps());
  SavedRun saved;
  saved.first.compression_mean = 0.25;
  saved.energy = {true, 7, 5, 9, 0.5, 0, 0, 0.08};
  saved.steps = StepHistory{};
  saved.steps->level = 1;
  saved.steps->hold = 8;
  s.solver.step(int(from), {});
  s.solver.calls.clear();
  CHECK(s.monitor.go_on_from(saved).update == from);
  CHECK(s.solver.kept() == from);
  s.run(10, from);
  CHECK(s.updates() == (from == 8 ? UpdateNumbers{10} : UpdateNumbers{8, 10}));
  CHECK(s.frames.seen == UpdateNumbers{9});
  CHECK(s.monitor.first().compression_mean == 0.25);
  CHECK(s.monitor.first().energy == 7);
  for (const auto& call : s.calls()) CHECK(call[2] == 1);
}

TEST_CASE("monitor: a run that goes on where it ends has no measure of it again") {
  WatchedSession s(ten_updates());
  s.solver.step(8, {});
  SavedRun saved;
  saved.energy = {true, 7, 5, 9, 0.5, 0, 0, 0.08};
  s.monitor.go_on_from(saved);
  s.run(8, 8);
  CHECK(s.taken.empty());
}

TEST_CASE("monitor: before a state is saved, a run that has no way back has it measured") {
  WatchedSession s(with_guard());
  s.solver.flow = [](Diagnostics& m) { m.non_finite = m.update == 7; };
  s.solver.fault = 5;
  std::vector<bool> good;
  s.behind.then = [&](Session& session) {
    if (session.update() == 4 || session.update() == 6) good.push_back(s.monitor.state_is_good());
    return Next::go_on;
  };
  s.run(6);
  CHECK(good == std::vector<bool>{true, true});
  CHECK(s.solver.measured == UpdateNumbers{0, 4, 6, 6});  // 4 is known; 6 is the end, too
  CHECK(s.updates() == UpdateNumbers{0, 4, 6});
  s.solver.step(1, {});
  CHECK_FALSE(s.monitor.state_is_good());
  REQUIRE(s.monitor.event());
  CHECK(s.monitor.event()->last_good.updates == 6);
  CHECK(s.updates() == UpdateNumbers{0, 4, 6});  // nobody gets what is wrong
  // One that goes back saves its last good state.
  WatchedSession back(with_shorter_steps());
  back.run(6);
  back.solver.step(1, {});
  const std::size_t measures = back.solver.measured.size();
  CHECK(back.monitor.state_is_good());
  CHECK(back.solver.measured.size() == measures);
  back.monitor.go_back();
  CHECK(back.solver.updates() == 6);
}

}  // namespace pbf::scene_test
