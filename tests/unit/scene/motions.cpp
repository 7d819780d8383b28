// What a scene may say of motions, every error about them with its remedy, and their files.
#include "lib/run/linked_files.h"

#include "lib/run/emit.h"
#include "lib/scene/difference.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

std::string obstacle(const std::string& motion) {
  return "obstacles: [{name: a, shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.2, motion: " +
         motion + "}]\n";
}
std::string motion_error(const std::string& motion, const std::vector<std::string>& set = {}) {
  return parse_error(kMinimal + obstacle(motion), set);
}
std::string tank_error(const std::string& motion, const std::vector<std::string>& set = {}) {
  return parse_error(kMinimal + "tank_motion: " + motion + "\n", set);
}
const std::vector<std::string> kFlatTank{"dimensions=2", "domain.max=[1, 0.1, 1]"};

/// What reading the file of the tank's motion says.
std::string file_error(const std::string& text, const std::string& tank = "",
                       const std::vector<std::string>& set = {}) {
  const test::TemporaryFolder folder;
  Scene s = parse(kMinimal + "tank_motion: {kind: file, path: m.csv" + tank + "}\n", set);
  const std::string place = "scene.yaml:6:33: ";
  folder.write("m.csv", text);
  try {
    read_linked_files(s, folder.path.string());
  } catch (const Error& e) {
    CHECK(e.code() == ExitCode::bad_input);
    std::string what = e.what(), dir = folder.path.string() + "/";
    CHECK(what.rfind(place, 0) == 0);  // where the scene names the file
    what.erase(0, place.size());
    const auto at = what.find(dir);
    return at == std::string::npos ? what : what.substr(0, at) + what.substr(at + dir.size());
  }
  return "";
}

}  // namespace

TEST_CASE("motions: every kind with its keys is read, also by --set, and written back") {
  const Scene s = parse(
      kMinimal +
          obstacle("{kind: sine, direction: [1, 0, 0], amplitude: 0.1, period: 2, phase: 90}") +
          "tank_motion: {kind: sine, axis: [0, 1, 0], amplitude: 4, period: 1.6, ramp: 0.5}\n",
      {"obstacles[0].motion.period=1.5"});
  const Motion& m = *s.obstacles[0].motion;
  CHECK(m.direction == Double3{1, 0, 0});
  CHECK_FALSE(m.axis);
  CHECK(m.period == 1.5);
  CHECK(m.phase == 90);
  CHECK(s.tank_motion->ramp == 0.5);
  CHECK(parse(resolved_yaml(s)) == s);
  const Scene gone = parse(kMinimal + obstacle("off"));
  CHECK_FALSE(gone.obstacles[0].motion);
  Scene other = s;
  other.obstacles[0].motion->amplitude = 0.2;
  CHECK(physics_difference(s, other) == "obstacles[0].motion.amplitude: 0.1 before, 0.2 now");
  other.obstacles[0].motion.reset();
  CHECK(physics_difference(s, other) == "obstacles[0].motion: on before, off now");
  CHECK(physics_difference(other, s) == "obstacles[0].motion: off before, on now");
}

TEST_CASE("motions: what is missing, misplaced or contradicts is named with its remedy") {
  CHECK(contains(motion_error("{kind: sine, direction: [1, 0, 0], period: 2}"),
                 "obstacles[0].motion.amplitude: missing; required"));
  CHECK(contains(motion_error("{amplitude: 2}"), "obstacles[0].motion.kind: missing; required"));
  CHECK(contains(motion_error("on"), "obstacles[0].motion.kind: missing; required"));
  CHECK(contains(motion_error("{kind: sin}"), "obstacles[0].motion.kind: "));
  CHECK(
      contains(motion_error("{kind: velocity, velocity: [1, 0, 0], period: 2}"),
               "obstacles[0].motion.period: belongs to kind sine, regular_waves, irregular_waves, "
               "focused_waves, this motion is a velocity; remove it or change the kind"));
  CHECK(contains(motion_error("{kind: velocity, velocty: [1, 0, 0]}"),
                 "obstacles[0].motion.velocty: unknown key, did you mean "
                 "obstacles[0].motion.velocity?"));
  CHECK(contains(motion_error("{kind: sine, amplitude: 1, period: 2}"),
                 "obstacles[0].motion: a sine needs direction (amplitude in m) or axis (degrees); "
                 "give one"));
  CHECK(contains(tank_error("{kind: sine, axis: [0, 1, 0], direction: [1, 0, 0], amplitude: 1, "
                            "period: 2}"),
                 "tank_motion: a sine needs direction or axis, not both; remove one"));
  CHECK(contains(tank_error("{kind: sine, axis: [0, 0, 0], amplitude: 1, period: 2}"),
                 "tank_motion.axis: has no direction; give one"));
  CHECK(contains(tank_error("{kind: sine, direction: [1, 0, 0], pivot: [0, 0, 0], amplitude: 1, "
                            "period: 2}"),
                 "tank_motion.pivot: is the point about which something turns, and there is no "
                 "axis; remove it"));
  CHECK(contains(tank_error("{kind: velocity, velocity: [1, 0, 0]}"), "tank_motion.kind: "));
  CHECK(contains(tank_error("{kind: file, path: ''}"), "tank_motion.path: "));
}

TEST_CASE("motions in two dimensions stay in the plane") {
  CHECK(contains(tank_error("{kind: sine, axis: [1, 0, 0], amplitude: 1, period: 2}", kFlatTank),
                 "tank_motion.axis: with dimensions: 2 nothing turns but about y"));
  CHECK(contains(motion_error("{kind: velocity, velocity: [0, 1, 0]}", kFlatTank),
                 "obstacles[0].motion.velocity: its y component is 1"));
  CHECK(contains(motion_error("{kind: velocity, angular: [0, 1, 2]}", kFlatTank),
                 "obstacles[0].motion.angular: with dimensions: 2 nothing turns but about y"));
  CHECK(contains(
      motion_error("{kind: sine, direction: [0, 1, 1], amplitude: 1, period: 2}", kFlatTank),
      "obstacles[0].motion.direction: its y component is 1"));
  CHECK(contains(file_error("t,ax,ay,az\n0,0,1,0\n2,0,0,0\n", "", kFlatTank),
                 "tank_motion.path: m.csv:2: ay is 1, with dimensions: 2 it must be 0"));
}

TEST_CASE("files of motions: what is wrong is named with its line") {
  CHECK(file_error("t,ax,ay,az\n0,0,0,0\n2,1,0,0\n") == "");
  CHECK(file_error("t,angle\n0,0\n2,1\n", ", axis: [0, 1, 0]") == "");
  CHECK(file_error("t,ax,ay,az\n0,0,0,0\n0.30,1,0,0\n0.30,1,0,0\n2,0,0,0\n") ==
        "tank_motion.path: m.csv:4: time 0.30 does not follow 0.30; times must grow");
  CHECK(file_error("t,x\n0,0\n") ==
        "tank_motion.path: m.csv:1: the header is \"t,x\", expected the header t,angle or "
        "t,ax,ay,az");
  CHECK(contains(file_error(""), "tank_motion.path: m.csv: is empty, expected the header"));
  CHECK(contains(file_error("t;ax;ay;az\n0;0;0;0\n2;0;0;0\n"),
                 "m.csv:1: the header is \"t;ax;ay;az\"; commas part the columns, decimals take a "
                 "point, expected the header t,angle or t,ax,ay,az"));
  CHECK(contains(file_error("t;ax;ay;az\n0,5;0;0;0\n"),
                 "m.csv:2: has 2 values, the header names "
                 "1; commas part the columns"));
  CHECK(contains(file_error("0,0,0,0\n2,0,0,0\n"),
                 "m.csv:1: the first line holds numbers, no header, expected the header"));
  // A path may lead to any file: what is no header is not shown.
  const std::string other = file_error("root:x:0:0:secret\n");
  CHECK(contains(other, "m.csv:1: the first line is no header"));
  CHECK_FALSE(contains(other, "secret"));
  // Of a spreadsheet.
  CHECK(file_error("\xEF\xBB\xBFt,ax,ay,az\r\n0,0,0,0\r\n2,1,0,0\r\n") == "");
  CHECK(file_error("t,ax,ay,az\n0,0,0,0\n2,1,zero,0\n") ==
        "tank_motion.path: m.csv:3: ay: \"zero\" is not a number");
  CHECK(contains(file_error("t,ax,ay,az\n0,0,0,0\n2,1,0\n"), "tank_motion.path: m.csv:3: has 3"));
  CHECK(file_error("t,ax,ay,az\n0,0,0,0\n0.5,0,0,0\n") ==
        "tank_motion.path: m.csv: goes from 0 to 0.5 s, the run from 0 to 1 s; give a table that "
        "lasts as long, or another time.end");
  CHECK(contains(file_error("t,ax,ay,az\n0,0,0,0\n2,0,0,0\n", "", {"time.motion_begin=1.5"}),
                 "the run from 1.5 to 2.5 s"));
  CHECK(contains(file_error("t,angle\n0,0\n2,1\n"), "holds angles; give tank_motion.axis"));
  CHECK(contains(file_error("t,ax,ay,az\n0,0,0,0\n2,1,0,0\n", ", axis: [0, 1, 0]"),
                 "holds accelerations, which have no axis"));
  CHECK(contains(file_error("t,ax,ay,az\n0,0,0,0\n"),
                 "needs at least two rows of numbers below the header"));
  Scene s = parse(kMinimal + "tank_motion: {kind: file, path: none.csv}\n");
  CHECK(
      contains(error_of([&] { read_linked_files(s, "."); }),
               "5 scene.yaml:6:33: tank_motion.path: ./none.csv: cannot be opened: No such file or "
               "directory; its path counts from the folder of the scene file"));
}

TEST_CASE("files of motions and bodies: the place in the scene stands before that in the file") {
  const test::TemporaryFolder folder;
  folder.write("p.csv", "t,x,y,z\n0,0,0,0\n2,0.1,0\n");
  Scene s = parse(kMinimal + obstacle("{kind: file, path: p.csv}"));
  const std::string dir = folder.path.string();
  CHECK(error_of([&] { read_linked_files(s, dir); }) ==
        "2 scene.yaml:6:103: obstacles[0].motion.path: " + dir +
            "/p.csv:3: has 3 values, the header names 4");
  folder.write("b.csv", "x,y,z\n0.1,0.1,oops\n");
  Scene b = parse(with_bodies("[{shape: file, path: b.csv}]"));
  const std::string place = "2 scene.yaml:3:30: bodies[0].path: " + dir + "/b.csv:2: z: ";
  CHECK(contains(error_of([&] { emit_particles(b, dir); }), place));
  CHECK(contains(error_of([&] { StartPoints(b, dir).files(); }), place));
  b.bodies[0].path = "none.csv";
  CHECK(contains(error_of([&] { count_particles(b, dir); }),
                 "5 scene.yaml:3:30: bodies[0].path: " + dir + "/none.csv: cannot be opened"));
  // A scene that was made and not read has no place, and equals one that was.
  Scene made = s;
  made.obstacles[0].motion->origin.text.clear();
  CHECK(made == s);
  CHECK(contains(error_of([&] { read_linked_files(made, dir); }), "2 obstacles[0].motion.path: "));
}

TEST_CASE("files of motions: the run keeps what it read of them, and may lie elsewhere") {
  const test::TemporaryFolder folder;
  folder.write("p.csv", "t,x,y,z\n0,0,0,0\n2,0.1,0,0\n");
  Scene s = parse(kMinimal + obstacle("{kind: file, path: p.csv}"));
  read_linked_files(s, folder.path.string());
  CHECK(s.obstacles[0].motion->table.values.size() == 2);
  const std::vector<SceneFile> files = StartPoints(s, folder.path.string()).files();
  REQUIRE(files.size() == 1);
  CHECK(files[0].path == "p.csv");
  CHECK(files[0].sha256.size() == 64);
  make_paths_absolute(s);
  Scene again = s;
  read_linked_files(again, "/elsewhere");
  CHECK(again == s);
}

}  // namespace pbf::scene_test
