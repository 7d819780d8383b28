// pbf run with obstacles: columns of their loads, the log, and runs that are stopped and go on.
#include <algorithm>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/in_pieces.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

void write_obstacle_scene(const Scratch& folder) {
  folder.write("s.yaml",
               "name: s\n"
               "domain: {min: [0, 0, 0], max: [1, 0.6, 1], loads: true}\n"
               "fluid: {spacing: 0.05}\n"
               "bodies:\n"
               "  - {shape: block, min: [0, 0, 0], max: [0.4, 0.6, 0.6]}\n"
               "  - {shape: block, min: [0.6, 0, 0], max: [0.8, 0.1, 0.1]}\n"
               "obstacles:\n"
               "  - {name: step, shape: box, min: [0.3, 0, 0], max: [0.5, 0.6, 0.1], loads: true}\n"
               "  - {name: a ball, shape: sphere, center: [0.7, 0.3, 0.3], radius: 0.1,\n"
               "     loads: true}\n"
               "  - {name: ramp, shape: plane, point: [1, 0, 0.2], normal: [-1, 0, 1]}\n"
               "time: {step: 0.002, end: 0.8}\n"
               "measure_every: 7\n"
               "output: {every: 0.01}\n");
}

}  // namespace

TEST_CASE("a run with obstacles writes their loads down and says what was left out") {
  const Scratch folder;
  write_obstacle_scene(folder);
  REQUIRE(run_scene(folder, "a", {"--set", "time.end=0.4"}).code == 0);
  const pbf::RunReader reader((folder / "a/run.vtkhdf").string());
  const auto columns = reader.log_columns();
  const auto there = [&](const std::string& name) {
    return std::count(columns.begin(), columns.end(), name) == 1;
  };
  for (const char* what :
       {"force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z", "force_peak"})
    for (const char* of : {"step", "a ball", "x_min", "z_max"})
      CHECK(there("load/" + std::string(of) + "/" + what));
  CHECK_FALSE(there("load/ramp/force_x"));  // has no `loads: true`
  // Step: 2 of 8 columns up to x = 0.4, 2 of 12 layers. Ramp: nothing of the first body.
  const std::string log = read_text(folder / "a/log.txt");
  CHECK(has(log,
            "48 particles of bodies[0] are in obstacles, or nearer to one than 0.4 spacings, and "
            "are left out"));
  CHECK_FALSE(has(log, "particles of bodies[1]"));
  CHECK(reader.frame(0).count == 8 * 12 * 12 - 48 + 4 * 2 * 2);
}

TEST_CASE("obstacles alone, without loads of the walls, have columns of their own alone") {
  const Scratch folder;
  write_obstacle_scene(folder);
  REQUIRE(run_scene(folder, "a", {"--set", "domain.loads=false", "--set", "time.end=0.1"}).code ==
          0);
  const auto columns = pbf::RunReader((folder / "a/run.vtkhdf").string()).log_columns();
  const auto loads = [&](const std::string& of) {
    return std::count_if(columns.begin(), columns.end(),
                         [&](const std::string& c) { return c.rfind("load/" + of, 0) == 0; });
  };
  CHECK(loads("step/") == 10);
  CHECK(loads("") == 20);
}

TEST_CASE("a stopped run with obstacles and loads ends in the bytes of the undisturbed run",
          "[slow]") {
  const Scratch folder;
  write_obstacle_scene(folder);
  REQUIRE(run_scene(folder, "a").code == 0);
  run_in_pieces(folder, "b", 0.1);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
  // And run again from its own file.
  REQUIRE(pbf::test::pbf({"run", "a/run.vtkhdf", "--out", "c", "--quiet"}, folder.path()).code ==
          0);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "c/run.vtkhdf") == "");
}

TEST_CASE("a changed obstacle is refused by --resume, which names the key") {
  const Scratch folder;
  write_obstacle_scene(folder);
  REQUIRE(run_scene(folder, "b", {"--max-walltime", "0.02"}).code == 75);
  const std::vector<std::pair<std::string, std::string>> bad{
      {"obstacles.0.max=[0.5,0.6,0.15]", "obstacles[0].max"},
      {"obstacles.0.turn_angle=1", "obstacles[0].turn_angle"},
      {"obstacles.1.radius=0.11", "obstacles[1].radius"},
      {"obstacles.1.loads=false", "obstacles[1].loads"},
      {"obstacles.2.normal=[-1,0,2]", "obstacles[2].normal"},
      {"obstacles=[]", "obstacles"}};
  for (const auto& [set, text] : bad) {
    const Outcome o = run_scene(folder, "b", {"--resume", "--set", set});
    CAPTURE(set, o.err);
    CHECK(o.code == 2);
    CHECK(has(o.err, text));
    CHECK(has(o.err, "--overwrite"));
  }
}

TEST_CASE("bodies inside obstacles are bad input with a remedy") {
  const Scratch folder;
  write_obstacle_scene(folder);
  const Outcome o = run_scene(
      folder, "a", {"--set", "obstacles.0.min=[-1,-1,-1]", "--set", "obstacles.0.max=[2,2,2]"});
  CHECK(o.code == 2);
  CHECK(has(o.err, "0 particles outside the obstacles; move the bodies or the obstacles"));
}
