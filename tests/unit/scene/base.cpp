// `base: other.yaml`: the scene of that file with the keys of this one laid over it; what comes
// out. What is refused: base_errors.cpp.
#include "lib/scene/base_scene.h"

#include <cmath>

#include "lib/base/inputs.h"
#include "lib/base/sha256.h"
#include "tests/support/base_scenes.h"
#include "tests/support/catch.h"

namespace pbf::scene_test {
namespace {

struct Laid {
  std::string over, same_as;  ///< of kBase with `over` on it
};

const std::string kBase =
    kMinimal +
    "gravity: 1.62\nsolver: {iterations: 3, substeps: 2}\nviscosity: {xsph: 0.2}\noutput: {every: "
    "0.5}\nrender: {every: 0.5, camera: {fov: 30}}\n"
    "tank_motion: {kind: sine, axis: [0, 1, 0], amplitude: 2, period: 3}\n";

}  // namespace

TEST_CASE("base: blocks are merged key by key, lists and values are replaced") {
  const Scenes files;
  files.write("base.yaml", kBase);
  const std::vector<Laid> cases{
      {"", kBase},
      {"name: b\n", kBase + "name: b\n"},
      {"solver: {iterations: 7, cfm: 2}\n", ""},
      {"solver.iterations: 7\nsolver.cfm: 2\n", ""},
      {"render: {camera: {orbit: 4}}\n", ""},
      {"render: {camera.orbit: 4}\n", ""},
  };
  for (const Laid& c : cases) {
    CAPTURE(c.over);
    const Scene s = files.scene("base: base.yaml\n" + c.over);
    if (!c.same_as.empty()) CHECK(s == parse(c.same_as));
    CHECK(s.solver.substeps == 2);
    CHECK(s.render->camera.fov == 30);
    if (contains(c.over, "solver")) CHECK(s.solver.iterations == 7);
    if (contains(c.over, "cfm")) CHECK(s.solver.cfm == 2);
    CHECK(s.render->camera.orbit == (contains(c.over, "orbit") ? 4 : 0));
    CHECK(parse(resolved_yaml(s)) == s);
    CHECK_FALSE(contains(resolved_yaml(s), "base"));
  }
  const Scene one = files.scene(
      "base: base.yaml\nbodies: [{shape: sphere, center: [0.5, 0.5, 0.5], radius: "
      "0.2}]\ndomain: {max: [2, 1, 1]}\n");
  REQUIRE(one.bodies.size() == 1);
  CHECK(one.bodies[0].shape == Shape::sphere);
  CHECK(one.domain.min == Double3{0, 0, 0});
  CHECK(one.domain.max == Double3{2, 1, 1});
}

TEST_CASE("base: the name of a base is not taken: each file's runs have a folder of their own") {
  const Scenes files;
  files.write("base.yaml", "name: tank\n" + kBase);
  files.write("mid.yaml", "base: base.yaml\nname: mid\n");
  files.write("low.yaml", "base: base.yaml\n");
  files.write("high.yaml", "base: mid.yaml\n");
  files.write("named.yaml", "base: mid.yaml\nname: own\n");
  for (const auto& [file, name] : std::vector<std::pair<std::string, std::string>>{
           {"base", "tank"}, {"mid", "mid"}, {"low", "low"}, {"high", "high"}, {"named", "own"}}) {
    const LoadedScene loaded = load_scene(files.path(file + ".yaml"), {});
    CHECK(loaded.scene.name == name);
    CHECK(loaded.named_by_file == (file == "low" || file == "high"));
  }
  files.write("twice.yaml", "name: a\nname: b\n" + kBase);
  CHECK(contains(files.error("base: twice.yaml\n"),
                 "twice.yaml:2:7 (included from my.yaml:1): name: given twice, first at"));
}

TEST_CASE("base: off, false and a written null take a block away, on gives its defaults") {
  const Scenes files;
  files.write("base.yaml", kBase);
  for (const char* word : {"off", "false", "null", "~", "Null", "NULL"}) {
    CAPTURE(word);
    CHECK_FALSE(files.scene(std::string("base: base.yaml\nviscosity: ") + word + "\n").viscosity);
    CHECK_FALSE(files.scene(std::string("{base: base.yaml, viscosity: ") + word + "}").viscosity);
  }
  CHECK(files.scene("base: base.yaml\nviscosity: on\n").viscosity->xsph == Viscosity{}.xsph);
  CHECK(files.scene("base: base.yaml\nviscosity: {}\n").viscosity->xsph == 0.2);
  CHECK_FALSE(files.scene("base: base.yaml\n", {"viscosity=null"}).viscosity);
  CHECK(contains(files.error("base: base.yaml\nviscosity:\nname: a\n"),
                 "my.yaml:3:1: viscosity: expected a block {xsph: ...}, got nothing"));
  files.write("dotted.yaml", kMinimal + "viscosity: {}\nviscosity.xsph: 0.3\n");
  CHECK(files.scene("base: dotted.yaml\n").viscosity->xsph == 0.3);
  CHECK(files.scene("base: dotted.yaml\nviscosity: {xsph: 0.4}\n").viscosity->xsph == 0.4);
  CHECK_FALSE(files.scene("base: dotted.yaml\nviscosity: off\n").viscosity);
}

TEST_CASE("base: --set comes after all of it") {
  const Scenes files;
  files.write("base.yaml", kBase);
  const Scene s =
      files.scene("base: base.yaml\nsolver: {iterations: 7}\n",
                  {"solver.iterations=9", "viscosity.xsph=0.3", "bodies.0.velocity=[1,0,0]"});
  CHECK(s.solver.iterations == 9);
  CHECK(s.viscosity->xsph == 0.3);
  CHECK(s.bodies[0].velocity == Double3{1, 0, 0});
}

TEST_CASE("base: gravity's magnitude can be tilted, a vector is replaced or refused") {
  const Scenes files;
  files.write("base.yaml", kBase);
  const double tilt = 5 * (3.14159265358979323846 / 180);
  CHECK(files.scene("base: base.yaml\ngravity: {tilt: 5}\n").gravity ==
        Double3{1.62 * std::sin(tilt), 0, -1.62 * std::cos(tilt)});
  CHECK(files.scene("base: base.yaml\ngravity: 3\n").gravity == Double3{0, 0, -3});
  files.write("vector.yaml", kMinimal + "gravity: [0, 0, -2]\n");
  CHECK(
      contains(files.error("base: vector.yaml\ngravity: {tilt: 5}\n"),
               "my.yaml:2:10: gravity: is a vector at vector.yaml:6:10 (included from my.yaml:1), "
               "of which no part can be changed; give the magnitude here too"));
  CHECK(files.scene("base: vector.yaml\ngravity: {magnitude: 4}\n").gravity[2] == -4);
  files.write("tilted.yaml", kMinimal + "gravity: {magnitude: 2, tilt: 90}\n");
  CHECK(files.scene("base: tilted.yaml\ngravity: {toward: y_max}\n").gravity == Double3{0, 2, 0});
}

TEST_CASE("base: another kind replaces its block") {
  const Scenes files;
  files.write("base.yaml", kBase);
  const Scene s = files.scene("base: base.yaml\ntank_motion: {kind: file, path: t.csv}\n");
  CHECK(s.tank_motion->kind == TankMotionKind::file);
  CHECK_FALSE(s.tank_motion->axis);
  CHECK(files.scene("base: base.yaml\ntank_motion: {kind: sine, period: 9}\n")
            .tank_motion->amplitude == 2);
  CHECK(files.scene("base: base.yaml\ntank_motion: {period: 9}\n").tank_motion->period == 9);
}

TEST_CASE("base: a base may have a base, from its own folder") {
  const Scenes files;
  files.write("common/fluid.yaml", kBase);
  files.write("common/deep/er.yaml", "base: ../fluid.yaml\nsolver: {iterations: 5}\nname: deep\n");
  const Scene s = files.scene("base: common/deep/er.yaml\nname: mine\n");
  CHECK(s.solver.iterations == 5);
  CHECK(s.solver.substeps == 2);
  CHECK(s.name == "mine");
  const LoadedScene loaded = load_scene(files.path("my.yaml"), {});
  CHECK(files.without(loaded.bases) == sha256(read_file(files.path("common/deep/er.yaml"))) +
                                           "  common/deep/er.yaml\n" + sha256(kBase) +
                                           "  common/deep/../fluid.yaml\n");
  CHECK(loaded.text == "base: common/deep/er.yaml\nname: mine\n");
  CHECK(input_at(files.path("common/fluid.yaml")) != "");  // no output takes its place
}

TEST_CASE("base: files that it names are meant from its folder") {
  const Scenes files;
  const std::string bodies =
      "bodies:\n  - {shape: file, path: p.csv}\n  - {shape: file, path: /abs/q.csv}\n"
      "obstacles:\n  - {name: a, shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.2, motion: "
      "{kind: file, path: ../m.csv}}\ntank_motion: {kind: file, path: t.csv}\n";
  files.write("sub/base.yaml", "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n" +
                                   bodies + "time: {step: 0.01, end: 1}\n");
  files.write("two/mid.yaml", "base: ../sub/base.yaml\n");
  Scene s = files.scene("base: sub/base.yaml\n");
  CHECK(s.bodies[0].path == "sub/p.csv");
  CHECK(s.bodies[1].path == "/abs/q.csv");
  CHECK(s.obstacles[0].motion->path == "sub/../m.csv");
  CHECK(s.tank_motion->path == "sub/t.csv");
  s = files.scene("base: two/mid.yaml\ntank_motion: {path: mine.csv}\n");
  CHECK(s.bodies[0].path == "two/../sub/p.csv");
  CHECK(s.tank_motion->path == "mine.csv");
  CHECK(files.scene("base: " + files.path("sub/base.yaml") + "\n").bodies[0].path ==
        files.path("sub/p.csv"));
}

}  // namespace pbf::scene_test
