// pbf run with wave makers: their file, a run that is extended, and irregular waves that would
// change if it were.
#include <string>

#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;

namespace {

std::string flume_with(const std::string& motion) {
  return "name: s\n"
         "dimensions: 2\n"
         "domain: {min: [0, 0, 0], max: [2, 0.02, 0.4]}\n"
         "fluid: {spacing: 0.02}\n"
         "bodies: [{shape: block, min: [0.2, 0, 0], max: [2, 0.02, 0.2]}]\n"
         "obstacles:\n"
         "  - {name: paddle, shape: box, min: [-0.3, 0, 0], max: [0.2, 0.02, 0.4],\n"
         "     motion: {" +
         motion +
         "}}\n"
         "gauges: [{name: G, kind: level, at: [1]}]\n"
         "time: {step: 0.004, end: 0.4}\n"
         "output: {every: 0.1, gauges_every: 0.02}\n";
}

}  // namespace

TEST_CASE("wave makers: keys, the file of their run, and a run that goes on give the same bytes") {
  const Scratch folder;
  folder.write("s.yaml",
               flume_with("kind: regular_waves, direction: [1, 0, 0], height: 0.05, period: 1"));
  REQUIRE(run_scene(folder, "a").code == 0);
  CHECK(has(read_text(folder / "a/log.txt"), "SHA-256 of waves_paddle.csv: "));
  REQUIRE(run_scene(folder, "b", {"--set", "time.end=0.2"}).code == 0);
  REQUIRE(run_scene(folder, "b", {"--resume"}).code == 0);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
  CHECK(read_text(folder / "a/waves_paddle.csv") == read_text(folder / "b/waves_paddle.csv"));
  folder.write("s.yaml", flume_with("kind: file, path: a/waves_paddle.csv"));
  REQUIRE(run_scene(folder, "c").code == 0);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "c/run.vtkhdf") == "");
}

TEST_CASE("wave makers: a sea whose lines follow from the run is not resumed into a longer one") {
  const Scratch folder;
  folder.write(
      "s.yaml",
      flume_with("kind: irregular_waves, direction: [1, 0, 0], height: 0.05, period: 0.2"));
  REQUIRE(run_scene(folder, "a").code == 0);
  const Outcome longer = run_scene(folder, "a", {"--resume", "--set", "time.end=1.2"});
  CHECK(longer.code == 2);
  CHECK(has(longer.err, "obstacles[0].motion.repeat: 1 before, 2 now"));
}
