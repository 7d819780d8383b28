// `base: other.yaml`: what is refused, and what the errors name.
#include <filesystem>
#include <fstream>

#include "tests/support/base_scenes.h"
#include "tests/support/catch.h"

namespace pbf::scene_test {

namespace fs = std::filesystem;

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
