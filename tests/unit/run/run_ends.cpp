// How a run ends that an alarm, a warning or an error of a writer ends, with a solver that only
// counts.
#include <cstdio>
#include <filesystem>

#include "lib/run/run.h"
#include "tests/support/catch.h"
#include "tests/support/counted_run.h"
#include "tests/support/run_file_disk.h"

namespace pbf::scene_test {

TEST_CASE("an alarm without a way back ends a run with 3, and the checkpoint before it stays") {
  CountedRun r(saving_always(with_guard()));
  r.solver.flow = [](Diagnostics& m) { m.non_finite = m.update >= 7; };
  r.solver.fault = 7;
  const std::string error = r.error();
  CHECK(error.rfind("3 ", 0) == 0);
  CHECK(contains(error, "guard_state.h5 the last good state (update 6)"));
  CHECK(r.run.status == "diverged");
  CHECK(r.status() == "diverged");
  CHECK(r.frames() == UpdateNumbers{0, 3, 6, 7});
  CHECK(r.saved().value().state.updates == 6);
  for (const char* name : {"guard_state.h5", "guard_scene.yaml"}) CHECK(r.folder.has(name));
}

TEST_CASE("a state that the guard objects to where it would be saved is not saved") {
  CountedRun r(saving_always(with_guard()));
  r.solver.flow = [](Diagnostics& m) { m.non_finite = m.update == 6; };  // no measure is due there
  r.solver.fault = 5;
  CHECK(r.error().rfind("3 ", 0) == 0);
  CHECK(r.run.status == "diverged");
  CHECK(r.saved().value().state.updates == 4);
  CHECK(r.solver.updates() == 5);
}

TEST_CASE("a strict run stops at its first warning, after saving, and ends with 6") {
  CountedRun r(ten_updates());
  r.control.strict = true;
  r.solver.flow = [](Diagnostics& m) {
    if (m.update >= 4) m.unresolved = 1, m.relative_way_max = 1.5;
  };
  const std::string error = r.error();
  CHECK(error.rfind("6 --strict: ", 0) == 0);
  CHECK(contains(error, "fluid may have passed through fluid"));
  CHECK(contains(error, "hold the run up to update 4 of 10"));
  CHECK(r.run.stop_reason == "--strict");
  CHECK(r.saved().value().state.updates == 4);
  CHECK(r.frames() == UpdateNumbers{0, 3, 4});
}

TEST_CASE("a disk that fills up ends a run with 5, and no checkpoint is ahead of the frames") {
  std::int64_t bytes = 0;
  {
    CountedRun whole(ten_updates());
    CHECK(whole.error() == "no error");
    bytes = whole.run.bytes;
  }
  for (const double share : {0.1, 0.9, 0.97}) {
    CAPTURE(share);
    CountedRun r(saving_always(ten_updates()));
    const std::string path = r.folder.file(kRunFile);
    {
      const test::WatchedDisk disk(path, std::int64_t(share * double(bytes)), false);
      const std::string error = r.error();
      CHECK(error.rfind("5 " + path + ": ", 0) == 0);
      CHECK(disk.refused() > 0);
    }
    CHECK(r.run.status == "");  // no observer came to its end
    CHECK_FALSE(r.run.writer);  // but all files are closed
    if (const auto saved = r.saved())
      CHECK(RunReader(path).frames() >= frames_until(saved->state.updates));
  }
}

TEST_CASE("rows that cannot be written end a run with 5 before anything follows on them") {
  CountedRun r(saving_always(ten_updates()));
  r.run.json = std::fopen("/dev/full", "w");
  REQUIRE(r.run.json);
  CHECK(contains(r.error(), "5 --log-json: cannot be written: "));
  std::fclose(r.run.json);
  CHECK(r.solver.calls.empty());
  CHECK_FALSE(r.saved());
  CHECK(r.run.status == "");
}

TEST_CASE("a checkpoint that cannot be written ends a run with 5, whose frames are there") {
  CountedRun r(ten_updates());
  r.stop_at(4);
  std::filesystem::create_directories(r.folder.file("checkpoint.h5.tmp") + "/in the way");
  const std::string error = r.error();
  CHECK(error.rfind("5 ", 0) == 0);
  CHECK(contains(error, "cannot write the checkpoint"));
  CHECK(r.frames() == UpdateNumbers{0, 3});
  CHECK(r.status() == "stopped");
  CHECK(r.run.status == "");  // no observer came to its end
  CHECK_FALSE(r.saved());
}

}  // namespace pbf::scene_test
