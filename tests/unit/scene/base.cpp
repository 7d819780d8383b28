// `base: other.yaml`: the scene of that file with the keys of this one laid over it.
#include "lib/scene/base_scene.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "lib/base/inputs.h"
#include "lib/base/sha256.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

namespace fs = std::filesystem;

/// Writes files and loads `my.yaml` among them.
struct Scenes {
  Folder folder;
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder.path / name).parent_path());
    return folder.write(name, text);
  }
  std::string path(const std::string& name) const { return (folder.path / name).string(); }
  Scene scene(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    Scene s = load_scene(write("my.yaml", text), overrides).scene;
    if (s.name == "my") s.name = Scene{}.name;  // as one that was parsed
    return s;
  }
  std::string error(const std::string& text, const std::string& base_folder = "") const {
    return without(error_of([&] { load_scene(write("my.yaml", text), {}, base_folder); }));
  }
  /// Messages with the names of files alone.
  std::string without(std::string text) const {
    for (const std::string& name :
         {folder.path.string() + "/", fs::canonical(folder.path).string() + "/"})
      for (std::size_t at; (at = text.find(name)) != text.npos;) text.erase(at, name.size());
    return text;
  }
};

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

TEST_CASE("base: errors name the file that they are in, and how one came there") {
  const Scenes files;
  files.write("low.yaml", kMinimal + "solver: {iterations: -1, cmf: 2}\n");
  files.write("mid.yaml", "# a comment\nbase: low.yaml\nrender: {every: 0}\n");
  const std::string error = files.error("\nbase: mid.yaml\nnme: x\n");
  CHECK(contains(error,
                 "low.yaml:6:22 (included from mid.yaml:2, from my.yaml:2): "
                 "solver.iterations: \"-1\" is out of range"));
  CHECK(contains(error,
                 "low.yaml:6:26 (included from mid.yaml:2, from my.yaml:2): solver.cmf: "
                 "unknown key, did you mean solver.cfm?"));
  CHECK(contains(error, "mid.yaml:3:17 (included from my.yaml:2): render.every: \"0\" is out"));
  CHECK(contains(error, "my.yaml:3:1: nme: unknown key, did you mean name?"));
  // What is replaced is not looked at.
  CHECK_FALSE(contains(files.error("base: low.yaml\nsolver: {iterations: 2}\n"), "iterations"));

  files.write("bad.yaml", "a: [1\n");
  CHECK(contains(files.error("base: bad.yaml\n"), "(included from my.yaml:1): not valid YAML"));
  files.write("bad.yaml", "a: \x01\n");
  CHECK(contains(files.error("base: bad.yaml\n"),
                 "bad.yaml:1:4 (included from my.yaml:1): is not plain text"));
  files.write("bad.yaml", "a: 1\n\tb: 2\n");
  CHECK(contains(files.error("base: bad.yaml\n"),
                 "bad.yaml:2:1 (included from my.yaml:1): a tab indents this line"));
  files.write("bad.yaml", "# nothing\n");
  CHECK(contains(files.error("base: bad.yaml\n"), "bad.yaml (included from my.yaml:1): is empty"));
  files.write("bad.yaml", "[1, 2]\n");
  CHECK(contains(files.error("base: bad.yaml\n"),
                 "bad.yaml:1:1 (included from my.yaml:1): is a list of 2, expected a scene"));
  files.write("bad.yaml", "solver: 3\nsolver: {iterations: 1}\n");
  CHECK(contains(files.error("base: bad.yaml\n" + kMinimal), "solver: given twice, first at"));
  CHECK(contains(files.error("base: low.yaml\nname: a\nname: b\n"),
                 "my.yaml:3:1: name: given twice, first at my.yaml:2:1"));
  files.write("study.yaml", "scene: my.yaml\ngrid: [{solver.iterations: [1, 2]}]\n");
  CHECK(contains(files.error("base: study.yaml\n"),
                 "study.yaml (included from my.yaml:1): is a study, expected a scene; pbf study "
                 "study.yaml takes it"));
  files.write("list.yaml", "a.yaml time.end=1\n");
  CHECK(contains(files.error("base: list.yaml\n"), "is a list of runs, expected a scene"));
  files.write("run.vtkhdf", std::string("\x89HDF\r\n\x1a\n\0\0", 10));
  CHECK(contains(files.error("base: run.vtkhdf\n"),
                 "run.vtkhdf (included from my.yaml:1): is an HDF5 file, expected a scene in YAML; "
                 "of a run file pbf plan run.vtkhdf --resolved prints the scene"));
  files.write("huge.yaml", std::string(5u << 20, ' '));
  CHECK(contains(files.error("base: huge.yaml\n"),
                 "huge.yaml (included from my.yaml:1): is larger than 4 MiB"));
  files.write("map.yaml", kMinimal);
  CHECK(contains(files.error("base: map.yaml\nbodies: {count: 4}\n"),
                 "my.yaml:2:9: bodies: is a block, and the base has a list at map.yaml:4:3 "
                 "(included from my.yaml:1); a list is replaced as a whole: give all of it"));
}

TEST_CASE("base: what is no path of a scene file") {
  const Scenes files;
  files.write("here.yaml", kMinimal);
  fs::create_directories(files.folder.path / "folder");
  CHECK(contains(files.error("base:\n" + kMinimal), "base: names no file; give the path"));
  for (const char* nothing : {"null", "~", "\"\""})
    CHECK(contains(files.error(std::string("base: ") + nothing + "\n"),
                   "my.yaml:1:7: base: names no file; give the path of a scene file, or remove"));
  CHECK(contains(files.error("base: off\n"), "my.yaml:1:7: base: is \"off\", expected the path"));
  CHECK(contains(files.error("base: [here.yaml, here.yaml]\n"),
                 "base: expected the path of one scene file, got a list of 2"));
  CHECK(contains(files.error("base: {file: here.yaml}\n"), "got a block"));
  CHECK(contains(files.error("base: folder\n"),
                 "my.yaml:1:7: base: folder is a folder, expected a scene file"));
  CHECK(contains(files.error("base: here.yaml\nbase: here.yaml\n"),
                 "my.yaml:2:7: base: given twice, first at my.yaml:1:7"));
  CHECK(contains(files.error("base: hre.yaml\n"),
                 "my.yaml:1:7: base: hre.yaml is not there (looked for hre.yaml); its path counts "
                 "from the folder of my.yaml"));
  CHECK(contains(files.error("base: here.yaml/x.yaml\n"), "base: here.yaml/x.yaml"));
  CHECK(contains(files.error("solver: {base: here.yaml}\n" + kMinimal), "solver.base: unknown"));
  CHECK(contains(files.error("bsae: here.yaml\n" + kMinimal), "did you mean base?"));
  CHECK(contains(files.error("include: here.yaml\n" + kMinimal), "base: other.yaml at the top"));
  CHECK(contains(parse_error(kMinimal + "base: here.yaml\n"), "is read with the scene file"));
  CHECK(contains(parse_error(kMinimal, {"base=here.yaml"}),
                 "--set base=here.yaml: base: is read with the scene file that it stands in"));
}

TEST_CASE("base: chains that come back, and those without an end") {
  const Scenes files;
  files.write("a.yaml", "base: sub/b.yaml\n");
  files.write("sub/b.yaml", "base: ../my.yaml\n");
  CHECK(contains(files.error("base: a.yaml\n"),
                 "sub/b.yaml:1:7 (included from a.yaml:1, from my.yaml:1): base: comes back to "
                 "where it began: my.yaml -> a.yaml -> sub/b.yaml -> sub/../my.yaml"));
  CHECK(contains(files.error("base: my.yaml\n"), "my.yaml:1:7: base: comes back"));
  fs::create_symlink("my.yaml", files.folder.path / "link.yaml");
  CHECK(contains(files.error("base: link.yaml\n"), "comes back"));
  for (int k = 1; k < 40; ++k)
    files.write("c" + std::to_string(k) + ".yaml", "base: c" + std::to_string(k + 1) + ".yaml\n");
  CHECK(
      contains(files.error("base: c1.yaml\n"), "base: the chain is longer than 16 files: my.yaml"));
  for (int k = 1; k < 15; ++k)
    files.write("d" + std::to_string(k) + ".yaml", "base: d" + std::to_string(k + 1) + ".yaml\n");
  files.write("d15.yaml", kMinimal);
  CHECK(files.scene("base: d1.yaml\n") == parse(kMinimal));  // 16 files
}

TEST_CASE("base: lies in the tree of the first scene's folder, links followed, or where allowed") {
  const Scenes files;
  const Folder outside;
  const std::string there = outside.write("o.yaml", kMinimal);
  const std::string gone = (outside.path / "gone.yaml").string();
  CHECK(contains(files.error("base: " + there + "\n"), "lies outside"));
  CHECK(contains(files.error("base: " + there + "\n"), "--base-folder"));
  CHECK(
      contains(files.error("base: " + gone + "\n"), "lies outside"));  // whether it is there or not
  CHECK(contains(files.error("base: ../" + outside.path.filename().string() + "/o.yaml\n"),
                 "lies outside"));
  fs::create_symlink(there, files.folder.path / "link.yaml");
  CHECK(contains(files.error("base: link.yaml\n"), "lies outside"));
  fs::create_directory_symlink(outside.path, files.folder.path / "way");
  CHECK(contains(files.error("base: way/o.yaml\n"), "lies outside"));
  CHECK(files.error("base: way/o.yaml\n", outside.path.string()) == "no error");
  CHECK(files.error("base: " + there + "\n", "/") == "no error");
  files.write("sub/in.yaml", kMinimal);
  CHECK(files.error("base: sub/in.yaml\n", outside.path.string()) == "no error");
  // A base's own base too: the tree is that of the first file.
  files.write("sub/out.yaml", "base: " + there + "\n");
  CHECK(contains(files.error("base: sub/out.yaml\n"),
                 "sub/out.yaml:1:7 (included from my.yaml:1): base: "));
  files.write("sub/up.yaml", "base: ../top.yaml\n");
  files.write("top.yaml", kMinimal);
  CHECK(files.error("base: sub/up.yaml\n") == "no error");
  CHECK(contains(error_of([&] { load_scene(files.path("sub/up.yaml"), {}); }), "lies outside"));
  // A folder whose name begins alike is another one.
  const std::string twin = files.folder.path.string() + "_twin";
  fs::create_directories(twin);
  std::ofstream(twin + "/o.yaml") << kMinimal;
  CHECK(contains(files.error("base: " + twin + "/o.yaml\n"), "lies outside"));
  fs::remove_all(twin);
}

TEST_CASE("base: byte order marks and blocks with many keys") {
  const Scenes files;
  files.write("bom.yaml", "\xEF\xBB\xBF" + kMinimal + "viscosity: null\n");
  CHECK(files
            .scene("\xEF\xBB\xBF"
                   "base: bom.yaml\nname: b\n")
            .name == "b");
  std::string many;
  for (int k = 0; k < 20000; ++k) many += "k" + std::to_string(k) + ": 1\n";
  files.write("many.yaml", kMinimal + many);
  CHECK(contains(files.error("base: many.yaml\nname: x\n"),
                 "(included from my.yaml:1): the scene has more than 10000 keys"));
  files.write("few.yaml", kMinimal);
  CHECK(contains(files.error("base: few.yaml\n" + many), "my.yaml:1:1: the scene has more than"));
}

}  // namespace pbf::scene_test
