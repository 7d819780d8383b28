// Nothing that a terminal obeys and nothing that is not UTF-8 passes through the program.
#include <algorithm>
#include <fstream>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

namespace {

/// No escape, no delete, no C1 byte sequence, no 0xff, which begins nothing in UTF-8.
bool is_clean(const std::string& text) {
  return text.find_first_of("\x1b\x7f\xff") == std::string::npos &&
         text.find("\xc2\x9b") == std::string::npos;
}

}  // namespace

TEST_CASE("files with control characters or bytes that are not UTF-8 are refused at their place",
          "[slow]") {
  const Scratch folder;
  const std::string nasty[] = {"\x1b[31m", "\x7f",
                               "\xc2\x9b"
                               "31m",
                               "\xff", "\x9b"};
  for (const std::string& bad : nasty) {
    CAPTURE(bad);
    folder.write("scene.yaml", tiny_scene("# a comment " + bad + "\n"));
    folder.write("study.yaml", "name: s\nscene: good.yaml\nerror: " + bad + "\n");
    folder.write("good.yaml", tiny_scene());
    folder.write("list", "good.yaml\ngood.yaml name=" + bad + "\n");
    folder.write("suite.yaml", "cases:\n  - {name: " + bad + "}\n");
    const std::string lines = std::to_string([&] {
      const std::string text = tiny_scene();
      return std::count(text.begin(), text.end(), '\n') + 1;
    }());
    const struct {
      std::vector<std::string> args;
      std::string place;
    } cases[] = {{{"plan", "scene.yaml"}, "scene.yaml:" + lines + ":13: is not plain text"},
                 {{"study", "study.yaml"}, "study.yaml:3:8: is not plain text"},
                 {{"stability", "--suite", "suite.yaml"}, "suite.yaml:2:12: is not plain text"},
                 {{"batch", "list"}, "list:2: the "},
                 {{"plan", "good.yaml", "--set", "name=" + bad}, "--set name="}};
    for (const auto& c : cases) {
      const Outcome r = pbf::test::pbf(c.args, folder.path());
      CAPTURE(c.args[0], r.err);
      CHECK(r.code == 2);
      CHECK(has(r.err, c.place));
      CHECK((has(r.err, "; remove it") || has(r.err, "; save the text as UTF-8") ||
             has(r.err, "; leave it out")));
      CHECK(is_clean(r.err));
    }
  }
}

TEST_CASE("control characters written as escapes in YAML are refused as well") {
  const Scratch folder;
  for (const char* text : {"\"\\e[31m\"", "\"\\x9b\"", "\"\\u007f\"", "\"\\0\"", "\"\\N\""}) {
    folder.write("scene.yaml", tiny_scene() + "name: " + text + "\n");
    for (const auto& args : {std::vector<std::string>{"plan", "scene.yaml"},
                             {"plan", "scene.yaml", "--set", std::string("solver.") + text + "=1"},
                             {"plan", "scene.yaml", "--set", std::string("name=") + text}}) {
      const Outcome r = pbf::test::pbf(args, folder.path());
      CAPTURE(text, r.err);
      CHECK(r.code == 2);
      CHECK(has(r.err, "an escape makes the "));
      CHECK(is_clean(r.err));
    }
  }
}

TEST_CASE("messages write out what arguments, file names and the environment hold") {
  const Scratch folder;
  folder.write("scene.yaml", tiny_scene());
  const std::string bad = "x\x1b]0;title\x07\xc2\x9b\xff\x7f";
  const std::string shown = "x\\u001b]0;title\\u0007\\u009b\\xff\\u007f";
  folder.write("points.csv", "x,y\x1b[2J,z\n0,0,0\n");
  folder.write("row.csv", "x,y,z\n0.5,0.5,\x1b[2J\n");
  folder.write(bad + ".yaml", "time: [\n");
  const struct {
    std::vector<std::string> args, environment;
    std::string fragment;
  } cases[] = {
      {{"run", bad}, {}, shown},
      {{bad}, {}, shown},
      {{"run", "scene.yaml", "--backend", bad}, {}, shown},
      {{"run", "scene.yaml", "--out", bad + "/" + bad, "--" + bad}, {}, shown},
      {{"plan", bad + ".yaml"}, {}, shown + ".yaml:"},
      {{"batch", "scene.yaml", "--grid", bad}, {}, shown},
      {{"render", bad}, {}, shown},
      {{"compare", bad, bad}, {}, shown},
      {{"info"}, {"PBF_SIMD=" + bad}, shown},
      {{"plan", "scene.yaml", "--set", "bodies=[{shape: file, path: points.csv}]"}, {}, ""},
      {{"run", "scene.yaml", "--set", "bodies=[{shape: file, path: row.csv}]"}, {}, ""}};
  for (const auto& c : cases) {
    const Outcome r = pbf::test::pbf(c.args, folder.path(), c.environment);
    CAPTURE(c.args[0], r.out, r.err);
    CHECK(r.code != 0);
    CHECK(r.code != 1);
    CHECK(has(r.err, c.fragment));
    CHECK(is_clean(r.err));
    CHECK(is_clean(r.out));
  }
}

TEST_CASE("a scene whose own path is no text runs, and its run file holds text alone") {
  const Scratch folder;
  const std::string name = "a\xff\x1b[1m.yaml";
  folder.write(name, tiny_scene());
  const Outcome run = pbf::test::pbf({"run", name, "--out", "out"}, folder.path());
  CHECK(run.code == 0);
  CHECK(is_clean(run.err));
  CHECK(is_clean(read_text(folder / "out/log.txt")));
  // The path stands in the file's attributes: written out, so that every reader can read it.
  CHECK(has(read_text(folder / "out/run.vtkhdf"), "a\\xff\\u001b[1m.yaml"));
  CHECK(pbf::test::pbf({"run", "out/run.vtkhdf", "--out", "again"}, folder.path()).code == 0);
  const Outcome batch = pbf::test::pbf({"batch", ".", "--out", "all"}, folder.path());
  CHECK(batch.code == 0);
  CHECK(is_clean(batch.err + batch.out + read_text(folder / "all/summary.csv")));
}
