// Runs whose start settles before time 0.
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

std::string tank(const Scratch& folder, const std::string& settle) {
  return folder.write("s.yaml",
                      "name: s\n"
                      "dimensions: 2\n"
                      "domain: {min: [0, 0], max: [0.6, 0.5]}\n"
                      "fluid: {spacing: 0.02}\n"
                      "bodies: [{shape: block, min: [0, 0], max: [0.6, 0.2]}]\n"
                      "settle: {duration: " +
                          settle +
                          ", gravity: [0.981, -9.81]}\n"
                          "time: {step: 0.0016, end: 0.32}\n"
                          "measure_every: 7\n"
                          "output: {every: 0.016}\n"
                          "checkpoint: {every: 1000}\n");
}

}  // namespace

TEST_CASE("settle: a run that is stopped and resumed does not settle again, and has the same bytes",
          "[slow]") {
  const Scratch folder;
  const std::string scene = tank(folder, "0.8");
  const Outcome whole = pbf::test::pbf({"run", scene, "--out", "a"}, folder.path());
  REQUIRE(whole.code == 0);
  CHECK(has(whole.err, "start: settled for 0.8 s before time 0, in 500 updates"));
  REQUIRE(
      pbf::test::pbf({"run", scene, "--out", "b", "--set", "time.end=0.16"}, folder.path()).code ==
      0);
  const Outcome rest = pbf::test::pbf({"run", scene, "--out", "b", "--resume"}, folder.path());
  REQUIRE(rest.code == 0);
  CHECK_FALSE(has(rest.err, "settled"));
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
}

TEST_CASE("settle: a signal while the start settles ends the run with 75, and nothing is left") {
  const Scratch folder;
  const std::string scene = tank(folder, "1000");
  Process run({"run", scene, "--out", "a"}, folder.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  run.send(SIGTERM);
  const Outcome o = run.wait();
  CHECK(o.code == 75);
  CHECK(has(o.err,
            "stopped early by SIGTERM while the start settled; nothing is saved, the same "
            "command begins again"));
  CHECK_FALSE(fs::exists(folder / "a"));
}

TEST_CASE("settle: plan counts the updates before time 0") {
  const Scratch folder;
  const std::string scene = tank(folder, "0.8");
  const Outcome plan = pbf::test::pbf({"plan", scene}, folder.path());
  CHECK(has(plan.out,
            "0.32 s in 200 updates of 0.0016 s after 500 updates in which the start "
            "settles"));
  CHECK(has(pbf::test::pbf({"plan", scene, "--json"}, folder.path()).out,
            "\"settling_updates\":500"));
  CHECK_FALSE(
      has(pbf::test::pbf({"plan", scene, "--set", "settle=off"}, folder.path()).out, "settles"));
}

TEST_CASE("settle: --strict ends a run whose start has not come to rest, after the run") {
  const Scratch folder;
  const std::string scene = tank(folder, "0.2");
  const Args run{"run",   scene,
                 "--out", "a",
                 "--set", "bodies.0.min=[0,0.2]",
                 "--set", "bodies.0.max=[0.6,0.4]"};
  const Outcome warned = pbf::test::pbf(run, folder.path());
  CHECK(warned.code == 0);
  CHECK(has(warned.err, "the start has not come to rest: after 0.2 s of settle.duration"));
  Args strict = run;
  strict.insert(strict.end(), {"--overwrite", "--strict"});
  CHECK(pbf::test::pbf(strict, folder.path()).code == 6);
}
