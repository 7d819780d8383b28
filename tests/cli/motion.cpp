// pbf run with what moves: the plan, the log, runs that are stopped and go on, files of motions.
#include <algorithm>
#include <cmath>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/in_pieces.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;

namespace {

void write_moving_scene(const Scratch& folder) {
  folder.write("heave.csv", "t,ax,ay,az\n0,0,0,0\n0.2,1,0,0\n2,-1,0,0\n");
  folder.write("gate.csv",
               "t,x,y,z,rx,ry,rz\n0,0,0,0,0,0,0\n0.5,0,0,0.1,0,20,0\n2,0,0,0.2,0,0,0\n");
  folder.write("s.yaml",
               "name: s\n"
               "dimensions: 2\n"
               "domain: {min: [0, 0, 0], max: [1, 0.02, 1], loads: true}\n"
               "fluid: {spacing: 0.02}\n"
               "bodies:\n"
               "  - {shape: block, min: [0.1, 0, 0], max: [1, 0.02, 0.4]}\n"
               "obstacles:\n"
               "  - {name: paddle, shape: box, min: [-0.1, 0, 0], max: [0.1, 0.05, 1],\n"
               "     motion: {kind: sine, direction: [1, 0, 0], amplitude: 0.05, period: 0.5}}\n"
               "  - {name: gate, shape: box, min: [0.5, 0, 0.2], max: [0.6, 0.05, 0.8],\n"
               "     motion: {kind: file, path: gate.csv}}\n"
               "tank_motion: {kind: file, path: heave.csv}\n"
               "time: {step: 0.002, end: 0.8}\n"
               "measure_every: 7\n"
               "output: {every: 0.01}\n");
}

}  // namespace

TEST_CASE("what moves: poses and work are columns of the log, the plan says what stands") {
  const Scratch folder;
  write_moving_scene(folder);
  REQUIRE(run_scene(folder, "a", {"--set", "time.end=0.4"}).code == 0);
  const pbf::RunReader reader((folder / "a/run.vtkhdf").string());
  const auto time = reader.log_column("time"), x = reader.log_column("pose/paddle/x"),
             turn = reader.log_column("pose/gate/turn_xz"), work = reader.log_column("work");
  REQUIRE(time.size() == x.size());
  for (std::size_t k = 0; k < time.size(); ++k)
    CHECK(x[k] == Approx(0.05 * std::sin(2 * std::acos(-1.0) * time[k] / 0.5)).margin(1e-12));
  CHECK(turn.front() == 0);
  CHECK(turn.back() > 0.2);
  CHECK(work.back() != 0);
  CHECK(has(read_text(folder / "a/log.txt"), "of what moves by itself"));
  const Outcome still =
      pbf::test::pbf({"plan", "s.yaml", "--set", "tank_motion=off"}, folder.path());
  CHECK(has(still.out, "motion of the tank: no key tank_motion"));
}

TEST_CASE("what moves: stopped and resumed, also with adaptive steps, the same bytes", "[slow]") {
  const Scratch folder;
  write_moving_scene(folder);
  std::vector<std::string> set{"--set", "solver.iterations=8"};
  if (GENERATE(false, true)) set.insert(set.end(), {"--set", "time.adaptive=on"});
  REQUIRE(run_scene(folder, "a", set).code == 0);
  run_in_pieces(folder, "b", 0.05, set);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
  // And run again from its own file, which finds the tables beside the scene.
  REQUIRE(pbf::test::pbf({"run", "a/run.vtkhdf", "--out", "c", "--quiet"}, folder.path()).code ==
          0);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "c/run.vtkhdf") == "");
}

TEST_CASE("what moves: a run is not resumed with another table, and a short one is refused") {
  const Scratch folder;
  write_moving_scene(folder);
  REQUIRE(run_scene(folder, "a", {"--max-walltime", "0.02"}).code == 75);
  folder.write("heave.csv", "t,ax,ay,az\n0,0,0,0\n2,-1,0,0\n");
  const auto again = run_scene(folder, "a", {"--resume"});
  CHECK(again.code == 2);
  CHECK(has(again.err, "heave.csv"));
  const auto longer = run_scene(folder, "b", {"--set", "time.end=3"});
  CHECK(longer.code == 2);
  CHECK(has(longer.err, "gate.csv: goes from 0 to 2 s, the run from 0 to 3 s"));
}
