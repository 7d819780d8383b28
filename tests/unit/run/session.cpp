// The loop over updates, with a solver that only counts and observers that only remember.
#include "lib/run/session.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>

#include "lib/program/schedule.h"
#include "tests/support/catch.h"
#include "tests/support/counting_solver.h"

using namespace pbf;

namespace {

using test::CountingSolver;
using test::Recorder;
using test::Told;
using test::UpdateNumbers;

}  // namespace

TEST_CASE("a session calls every observer at the updates that it asks for, and at no other") {
  CountingSolver solver;
  Told told;
  Recorder threes("a", 3, told), fives("b", 5, told);
  Session(solver, {&threes, &fives}).run(11);
  CHECK(solver.updates() == 11);
  CHECK(threes.seen == UpdateNumbers{0, 3, 6, 9});
  CHECK(fives.seen == UpdateNumbers{0, 5, 10});
  // No more calls than there are updates asked for.
  CHECK(solver.calls.size() == 6);
}

TEST_CASE("observers of the same update are called in their order, and end and close so") {
  CountingSolver solver;
  Told told;
  Recorder a("a", 4, told), b("b", 2, told);
  Session(solver, {&a, &b}).run(4);
  CHECK(told ==
        Told{"a 0", "b 0", "b 2", "a 4", "b 4", "a ends 4", "b ends 4", "a closes", "b closes"});
}

TEST_CASE("without observers a session is one call, which is timed") {
  CountingSolver solver;
  solver.seconds = 1e-4;
  Session session(solver);
  session.run(40);
  CHECK(session.seconds().wall >= 0.004);
  CHECK(session.seconds().cpu > 0);
  session.run(40);
  session.run(70);
  advance(solver, 5);
  REQUIRE(solver.calls.size() == 3);
  CHECK(solver.calls[0].updates == 40);
  CHECK(solver.calls[1].updates == 30);
  CHECK(solver.calls[2].updates == 5);
}

TEST_CASE("calls are no longer than asked for, so that a signal does not wait") {
  CountingSolver solver;
  solver.seconds = 1e-3;
  Told told;
  Recorder every_call("a", kEveryCall, told), always("b", kAlways, told);
  Session(solver, {&every_call, &always}, 0.004).run(12);
  CHECK(solver.calls.at(0).updates == 1);  // it is not known yet how long an update takes
  for (const auto& call : solver.calls) CHECK(call.updates <= 4);
  CHECK(every_call.seen.size() == solver.calls.size());
  CHECK(always.seen.size() == solver.calls.size() + 1);
  CHECK(always.seen.front() == 0);
  CHECK(every_call.seen.front() == 1);
}

TEST_CASE("updates of more steps are fewer in a call from the next one on") {
  CountingSolver solver;
  solver.seconds = 1e-4;
  Told told;
  Recorder at_100("a", 100, told);
  at_100.then = [&](Session& s) {
    if (s.update() == 100) s.use({.level = 6});
    return Next::go_on;
  };
  Session(solver, {&at_100}, 0.01).run(200);
  std::int64_t done = 0;
  for (const auto& call : solver.calls) {
    CHECK(call.options.level == (done < 100 ? 0 : 6));
    if (done == 100) CHECK(call.updates <= 2);  // 64 times as long
    done += call.updates;
  }
}

TEST_CASE("an observer that goes back has the updates since repeated for all behind it") {
  CountingSolver solver;
  Told told;
  Recorder judge("judge", 4, told), row("row", 4, told), call("call", kEveryCall, told);
  bool once = true;
  judge.then = [&](Session& s) {
    if (s.update() == 8 && std::exchange(once, false))
      s.solver().set_state(s.solver().state(StateOf::kept));
    else
      s.solver().keep();
    return Next::go_on;
  };
  Session(solver, {&judge, &row, &call}).run(12);
  CHECK(judge.seen == UpdateNumbers{0, 4, 8, 8, 12});
  CHECK(row.seen == UpdateNumbers{0, 4, 8, 12});  // the first 8 never was
  CHECK(call.seen == UpdateNumbers{4, 4, 8, 12});
  std::int64_t done = 0;
  for (const auto& c : solver.calls) done += c.updates;
  CHECK(done == 16);
}

TEST_CASE("what stops a session is followed by nothing but the ends, at the update it leaves") {
  CountingSolver solver;
  Told told;
  Recorder frames("frames", 2, told), stop("stop", 6, told), behind("behind", 6, told);
  const bool back = GENERATE(false, true);
  stop.then = [&](Session& s) {
    if (s.update() == 0) s.solver().keep();
    if (s.update() == 0) return Next::go_on;
    if (back) s.solver().set_state(s.solver().state(StateOf::kept));
    return Next::stop;
  };
  Session(solver, {&frames, &stop, &behind}).run(100);
  const std::string at = back ? " ends 0" : " ends 6";
  CHECK(told == Told{"frames 0", "stop 0", "behind 0", "frames 2", "frames 4", "frames 6", "stop 6",
                     "frames" + at, "stop" + at, "behind" + at, "frames closes", "stop closes",
                     "behind closes"});
}

TEST_CASE("a session can be stopped before its first update") {
  CountingSolver solver;
  Told told;
  Recorder stop("stop", kAlways, told);
  stop.then = [](Session&) { return Next::stop; };
  Session(solver, {&stop}, 0.25).run(10);
  CHECK(solver.calls.empty());
  CHECK(told == Told{"stop 0", "stop ends 0", "stop closes"});
}

TEST_CASE("where an observer throws, all are closed in order and none is ended") {
  CountingSolver solver;
  Told told;
  Recorder a("a", 5, told), broken("broken", 5, told), c("c", 5, told);
  broken.then = [](Session& s) {
    if (s.update() == 5) throw std::runtime_error("the disk is full");
    return Next::go_on;
  };
  CHECK_THROWS_WITH(Session(solver, {&a, &broken, &c}).run(10), "the disk is full");
  CHECK(told ==
        Told{"a 0", "broken 0", "c 0", "a 5", "broken 5", "a closes", "broken closes", "c closes"});
}

TEST_CASE("a session that goes on from a state does not repeat what was done there") {
  CountingSolver solver;
  SolverState saved;
  saved.updates = 6;
  solver.set_state(saved);
  Told told;
  Recorder threes("a", 3, told), call("b", kEveryCall, told), always("c", kAlways, told);
  Session(solver, {&threes, &call, &always}).run(12, 6);
  CHECK(threes.seen == UpdateNumbers{9, 12});
  CHECK(call.seen == UpdateNumbers{9, 12});
  CHECK(always.seen == UpdateNumbers{6, 9, 12});
  // Nothing is left to do: no update, but the ends.
  told.clear();
  Session(solver, {&threes}).run(12, 12);
  CHECK(told == Told{"a ends 12", "a closes"});
}

TEST_CASE("the next update of a schedule is a multiple of an interval, or the last") {
  Schedule s;
  s.updates = 20;
  s.measure_every = 8;
  s.frame_every = 5;
  CHECK(s.next_measure(-1) == 0);
  CHECK(s.next_measure(0) == 8);
  CHECK(s.next_measure(16) == 20);
  CHECK(s.next_output(5) == 10);
  CHECK(s.next_event(5) == 8);
  CHECK(s.next_event(8) == 10);
  CHECK(next_multiple(-1, 1) == 0);
  CHECK(next_multiple(7, 1) == 8);
}

TEST_CASE("the session is the only place that makes updates of a solver") {
  namespace fs = std::filesystem;
  // Steps without time are no updates.
  const std::regex step("solver\\w*(->|\\.)step\\((?![^;]*without_time)|\\b[abc](->|\\.)step\\(");
  std::vector<std::string> places;
  for (const char* folder : {"app", "lib"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(PBF_SOURCE_DIR) / folder)) {
      if (!entry.is_regular_file()) continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      if (std::regex_search(text.str(), step))
        places.push_back(fs::relative(entry.path(), PBF_SOURCE_DIR).string());
    }
  CHECK(places == std::vector<std::string>{"lib/run/session.cpp"});
}
