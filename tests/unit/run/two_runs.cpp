// Two runs in two threads of one process share nothing that one of them could stop, save or spoil.
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <mutex>
#include <thread>

#include "lib/run/signals.h"
#include "lib/run/start.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

namespace fs = std::filesystem;

Scene pool(double end) {
  return parse(kMinimal + "threads: 1\ngravity: [0, 0, -9.81]\noutput: {every: 0.1}\n",
               {"time.end=" + std::to_string(end)});
}

/// A run with a token and a log of its own.
struct OwnRun {
  StopToken stop;
  std::string told;  ///< every line, of this run alone
  Log log{[this](const std::string& lines) { told += lines; }};
  RunResult result;
  std::string error;
  void go(const Scene& scene, const std::string& out) {
    try {
      Control control{stop, log};
      result = run(prepare(scene, "."), {out}, control);
    } catch (const std::exception& e) {
      error = e.what();
    }
  }
};

}  // namespace

TEST_CASE("of two runs in two threads of one process, one is saved and stopped alone") {
  const Folder folder;
  const std::string long_out = folder / "long", short_out = folder / "short",
                    alone = folder / "alone";
  OwnRun endless, brief, again;
  std::thread first([&] { endless.go(pool(100000), long_out); });
  std::thread second([&] { brief.go(pool(2), short_out); });
  endless.stop.ask_save();
  test::wait_until([&] { return fs::exists(long_out + "/checkpoint.h5"); });
  second.join();
  CHECK(brief.error == "");
  CHECK(brief.result.stop_reason == "");
  CHECK(brief.result.updates == 200);
  CHECK(fs::exists(short_out + "/DONE"));
  CHECK_FALSE(fs::exists(short_out + "/checkpoint.h5"));  // the other one's token
  CHECK(endless.stop.why() == nullptr);
  endless.stop.ask("the test");
  endless.stop.ask("another reason, which comes too late");
  first.join();
  CHECK(endless.error == "");
  CHECK(endless.result.stop_reason == "the test");
  CHECK(endless.result.updates > 0);
  CHECK(endless.result.updates < 10000000);
  CHECK_FALSE(fs::exists(long_out + "/DONE"));
  // Each log has its own run alone, and log.txt the same lines.
  CHECK(contains(endless.told, "stopped early by the test after update "));
  CHECK(contains(endless.told, long_out));
  CHECK_FALSE(contains(endless.told, short_out));
  CHECK_FALSE(contains(brief.told, "stopped early"));
  CHECK(test::read_file(short_out + "/log.txt") == brief.told);
  // Beside another one a run has the bytes that it has alone.
  again.go(pool(2), alone);
  CHECK(again.error == "");
  CHECK(test::run_difference(short_out + "/run.vtkhdf", alone + "/run.vtkhdf") == "");
}

TEST_CASE(
    "of two runs in two threads of one process, one ends with an error and the other runs on") {
  const Folder folder;
  OwnRun good, bad;
  Scene broken = pool(1);
  broken.bodies[0].max = {2, 1, 1};
  std::thread first([&] { bad.go(broken, folder / "bad"); });
  std::thread second([&] { good.go(pool(0.1), folder / "good"); });
  first.join();
  second.join();
  CHECK(contains(bad.error, "is outside the domain along x"));
  CHECK_FALSE(fs::exists(folder / "bad"));
  CHECK(good.error == "");
  CHECK(good.result.updates == 10);
}

TEST_CASE("the first signal ends no process whose token somebody else has asked to stop") {
  const pid_t child = fork();
  if (child == 0) {
    watch_signals();
    signal_token().ask("the test");
    raise(SIGTERM);
    _exit(0);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
}

}  // namespace pbf::scene_test
