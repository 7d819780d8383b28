// What a run leaves in its folder, and when: frames, rows and checkpoints of a solver that only
// counts.
#include <algorithm>
#include <cmath>
#include <optional>

#include "lib/base/version.h"
#include "lib/io/run_path.h"
#include "lib/run/resume.h"
#include "lib/run/run.h"
#include "lib/run/run_record.h"
#include "tests/support/catch.h"
#include "tests/support/counted_run.h"
#include "tests/support/run_file_samples.h"

namespace pbf::scene_test {

TEST_CASE("a run has each frame and row once, at its interval and at the end, with its state") {
  CountedRun r(ten_updates());
  CHECK(r.error() == "no error");
  CHECK(r.frames() == UpdateNumbers{0, 3, 6, 9, 10});
  CHECK(r.steps_of_frames() == UpdateNumbers{0, 3, 6, 9, 10});
  CHECK(r.column("update") == std::vector<double>{0, 4, 8, 10});
  CHECK(r.status() == "finished");
  CHECK(r.run.status == "finished");
  CHECK(r.run.frames_written == 5);
  CHECK_FALSE(r.saved());  // no key checkpoint
  Scene even = ten_updates();
  even.time.end = 0.12;
  CountedRun whole(even);
  CHECK(whole.error() == "no error");
  CHECK(whole.frames() == UpdateNumbers{0, 3, 6, 9, 12});
  CHECK(whole.column("update") == std::vector<double>{0, 4, 8, 12});
}

TEST_CASE("a run that goes back has each frame and row once, of what came out in the end") {
  const std::int64_t wrong = GENERATE(6, 8);  // a frame, a measure
  CAPTURE(wrong);
  CountedRun r(saving_always(with_shorter_steps()));
  r.solver.flow = wrong_at(r.solver, wrong);
  CHECK(r.error() == "no error");
  CHECK(r.frames() == UpdateNumbers{0, 3, 6, 9, 10});
  // From the last good state on, 4 or 6, there are two steps in an update.
  CHECK(r.steps_of_frames() ==
        (wrong == 6 ? UpdateNumbers{0, 3, 8, 14, 16} : UpdateNumbers{0, 3, 6, 12, 14}));
  CHECK(r.column("update") == std::vector<double>{0, 4, 8, 10});
  CHECK(r.column("dt") == std::vector<double>{0.01, 0.01, 0.005, 0.005});
}

TEST_CASE("a frame is of the state as it was measured, before what a shorter step does to it") {
  CountedRun r(with_shorter_steps());
  r.solver.flow = [&](Diagnostics& m) {
    m.speed_max = 16;
    m.compression_mean = 0.1 * std::exp2(-double(r.solver.steps_without_time() / 4));
  };
  CHECK(r.error() == "no error");
  const RunReader file(r.folder.file(kRunFile));
  const auto without_time = [&](std::int64_t k) {
    return file.frame(k).fields.at(0).as<float>()[1];
  };
  CHECK(without_time(0) == 0);
  CHECK(without_time(1) == 8);
}

TEST_CASE(
    "checkpoints come last: all before them is on the disk, and they are the solver's state") {
  CountedRun r(saving_always(ten_updates()));
  r.solver.flow = [](Diagnostics& m) {
    m.energy = 5 + double(m.update);
    m.compression_max = m.update == 10 ? 0.5 : 0.1 * double(m.update);
  };
  UpdateNumbers at;
  r.solver.before_state = [&] {
    const std::int64_t u = r.solver.updates();
    at.push_back(u);
    if (r.run.writer) CHECK(r.run.writer->frames_written() == frames_until(u));
    if (!r.run.writer) CHECK(u == 10);
    if (at.size() > 1) CHECK(r.saved()->state.updates == at[at.size() - 2]);
  };
  CHECK(r.error() == "no error");
  // After every call, before the first one, and at the end: once each.
  CHECK(std::is_sorted(at.begin(), at.end()));
  CHECK(std::adjacent_find(at.begin(), at.end()) == at.end());
  for (const std::int64_t u : {0, 3, 4, 6, 8, 9, 10})
    CHECK(std::find(at.begin(), at.end(), u) != at.end());
  const SavedRun saved = r.saved().value();
  r.solver.before_state = [] {};
  CHECK(saved.state.updates == 10);
  CHECK(saved.state.steps == 10);
  CHECK(saved.state.position == r.solver.state(StateOf::present).position);
  CHECK(saved.energy.first == 5);
  // What a longer run would not have is not in it: the measure at the end of this one.
  CHECK(saved.energy.time == Approx(0.08));
  CHECK(saved.energy.largest == 13);
  CHECK(saved.compression_max == Approx(0.8));
  CHECK(r.run.compression_max == Approx(0.8));
}

TEST_CASE("a checkpoint of a run that goes back holds its last good state, not the present one") {
  CountedRun r(saving_always(with_shorter_steps()));
  UpdateNumbers at, in_checkpoints;
  r.solver.before_state = [&] {
    at.push_back(r.solver.updates());
    if (at.size() > 1) in_checkpoints.push_back(r.saved()->state.updates);
  };
  CHECK(r.error() == "no error");
  CHECK(at.at(1) == 1);  // the first call is of one update
  CHECK(in_checkpoints.at(1) == 0);
  for (const std::int64_t u : in_checkpoints) CHECK((u % 3 == 0 || u % 4 == 0));
  // The end of this run is none of a longer one.
  CHECK(r.saved()->state.updates == 9);
}

TEST_CASE("a run that is stopped saves the state that it leaves, with a frame and a row of it") {
  CountedRun r(ten_updates());
  r.stop_at(4);
  CHECK(r.error() == "no error");
  CHECK(r.run.status == "stopped");
  CHECK(r.run.stop_reason == "--max-walltime");
  CHECK(r.status() == "stopped");
  CHECK(r.solver.updates() == 4);
  CHECK(r.frames() == UpdateNumbers{0, 3, 4});
  CHECK(r.column("update") == std::vector<double>{0, 4});
  CHECK(r.saved().value().state.position == r.solver.state(StateOf::present).position);
  // At the last update there is nothing to stop.
  CountedRun late(ten_updates());
  late.stop_at(10);
  CHECK(late.error() == "no error");
  CHECK(late.run.status == "finished");
  CHECK_FALSE(late.saved());
}

TEST_CASE(
    "a run whose wall time is over stops at its start, one that goes back at its first event") {
  CountedRun plain(ten_updates());
  plain.control.max_walltime = 1e-9;
  CHECK(plain.error() == "no error");
  CHECK(plain.solver.calls.empty());
  CHECK(plain.frames() == UpdateNumbers{0});
  CHECK(plain.column("update") == std::vector<double>{0});
  CHECK(plain.saved().value().state.updates == 0);
  CountedRun back(with_shorter_steps());
  back.control.max_walltime = 1e-9;
  CHECK(back.error() == "no error");
  CHECK(back.frames() == UpdateNumbers{0, 3});
  CHECK(back.saved().value().state.updates == 3);
  CHECK(back.run.status == "stopped");
}

TEST_CASE(
    "a run that goes back and is stopped in between leaves nothing behind its last good state") {
  CountedRun r(with_shorter_steps());
  const Silence silence;
  open_files(r.run, "2026-01-01T00:00:00Z");
  // As run_session() has them, and one that asks for the end at update 5.
  std::optional<run_module::LogRows> rows;
  Monitor monitor(r.run.scene, r.run.plan, r.run.solver,
                  [&](Diagnostics& m, double dt) { rows->take(m, dt); });
  Reporter reporter(r.run, monitor);
  rows.emplace(r.run, reporter);
  Frames frames(r.run, reporter);
  Told told;
  Recorder asks("asks", 5, told);
  asks.then = [&](Session& session) {
    if (session.update() == 5) r.control.max_walltime = 1e-9;
    return Next::go_on;
  };
  Saving saving(r.run, frames, *rows, monitor, reporter);
  Session(r.solver, {&monitor, &frames, &monitor.choosing(), &reporter, &asks, &saving}).run(10);
  CHECK(asks.seen == UpdateNumbers{0, 5});
  CHECK(r.solver.updates() == 4);
  CHECK(r.saved().value().state.updates == 4);
  CHECK(r.frames() == UpdateNumbers{0, 3, 4});
  CHECK(r.column("update") == std::vector<double>{0, 4});
}

TEST_CASE("a run in which particles appear and disappear goes on after a stop as if undisturbed") {
  const auto alive = [](std::int64_t u) {
    UpdateNumbers ids;
    for (std::int64_t id = u; id < 2 * u + 2; ++id)
      if (id % 4 != 1 && u != 6) ids.push_back((std::int64_t{1} << 33) + id);
    return ids;
  };
  Scene scene = ten_updates();
  scene.precision = Precision::dbl;  // as the state of this solver
  scene.checkpoint.emplace();
  scene.sinks = {{"drain", {0, 0, 0}, {0.1, 0.1, 0.1}}};  // their number may change
  scene.capacity = 20;
  CountedRun whole(scene), stopped(scene);
  whole.solver.ids = stopped.solver.ids = alive;
  CHECK(whole.error() == "no error");
  stopped.stop_at(4);
  CHECK(stopped.error() == "no error");
  REQUIRE(stopped.run.status == "stopped");
  CHECK(stopped.saved().value().state.id == alive(4));
  CHECK(stopped.saved().value().particles == std::int64_t(alive(4).size()));

  stopped.folder.write_text(kResolvedScene, scene_record(stopped.run.scene, ""));
  const auto resume_point = [&](const Scene& s) {
    return find_resume_point(stopped.folder, s, {}, make_plan(s, 2), build_info().commit);
  };
  const ResumePoint from = resume_point(scene);
  REQUIRE(from.saved);
  CHECK(from.frames == 2);  // the third is of the stop
  CountingSolver solver;
  solver.ids = alive;
  solver.measures = stopped.solver.measures;
  solver.set_state(from.saved->state);
  stopped.control.max_walltime = 0;
  RunParts again{stopped.start, solver, stopped.control, stopped.clock, stopped.folder, from};
  {
    const Silence silence;
    open_files(again, "2026-01-01T00:00:00Z");
    run_session(again);
  }
  const RunReader a(whole.folder.file(kRunFile)), b(stopped.folder.file(kRunFile));
  REQUIRE(a.updates() == b.updates());
  for (std::int64_t k = 0; k < a.frames(); ++k) {
    CHECK(test::same(a.frame(k), b.frame(k)));
    CHECK(ids_of(b.frame(k)) == alive(b.updates()[std::size_t(k)]));
  }
  CHECK(a.counts() == UpdateNumbers{1, 4, 0, 8, 9});
  // With another number of particles at most, it is another scene.
  scene.capacity = 0;
  CHECK(contains(error_of([&] { resume_point(scene); }), "capacity: 20 before, auto now"));
}

}  // namespace pbf::scene_test
