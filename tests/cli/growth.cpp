// Studies, lists and settings are read in time that grows with their length. What compared every
// entry with every other took minutes to hours for these, which the timeout of the test catches.
#include <functional>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

namespace {

std::string repeated(int count, const std::function<std::string(const std::string&)>& piece) {
  std::string text;
  for (int i = 0; i < count; ++i) text.append(piece(std::to_string(i)));
  return text;
}

}  // namespace

TEST_CASE("a study with a hundred thousand keys or variants is refused with the limit", "[slow]") {
  const Scratch folder;
  folder.write("scene.yaml", tiny_scene());
  const struct {
    const char *head, *before, *after, *fragment;
  } cases[] = {
      {"grid:", "\n  k", ": [1]", "study.yaml:3:3: grid: has 100000 entries, at most 10000"},
      {"grid:", "\n  - {k", ": [1]}", "study.yaml:3:3: grid: has 100000 entries, at most 10000"},
      {"grid: [{a: [1]", ", k", ": [1]", "study.yaml:2:8: grid: has 100001 entries, at most 10000"},
      {"variants:", "\n  - {name: v", "}", "variants: has 100000 entries, at most 10000"},
      {"set:", "\n  k", ": 1", "the scene has more than 10000 keys; leave some out"},
      {"reference:", "\n  solver.k", ": 1", "solver has more than 10000 keys; leave some out"}};
  for (const auto& c : cases) {
    const std::string end = c.head == std::string("grid: [{a: [1]") ? "}]\n" : "\n";
    folder.write(
        "study.yaml",
        std::string("scene: scene.yaml\n") + c.head + repeated(100000, [&c](const std::string& i) {
          return std::string(c.before).append(i).append(c.after);
        }) + end);
    const Outcome r = pbf::test::pbf({"study", "study.yaml", "--list"}, folder.path());
    CAPTURE(c.head, r.err.substr(0, 400));
    CHECK(r.code == 2);
    CHECK(has(r.err, c.fragment));
  }
}

TEST_CASE("a list names a hundred thousand runs of one scene, each by a number of its own",
          "[slow]") {
  const Scratch folder;
  folder.write("scene.yaml", tiny_scene());
  folder.write("list", repeated(100000, [](const std::string&) { return "scene.yaml\n"; }));
  const Outcome r = pbf::test::pbf({"batch", "list", "--list", "--out", "o"}, folder.path());
  CHECK(r.code == 0);
  CHECK(has(r.out, "scene_2"));
  CHECK(has(r.out, "scene_100000"));
  CHECK_FALSE(has(r.out, "scene_100001"));
}

TEST_CASE("ten thousand arguments --set of one scene are applied") {
  const Scratch folder;
  folder.write("scene.yaml", tiny_scene());
  std::vector<std::string> args{"plan", "scene.yaml"};
  for (int i = 0; i < 10000; ++i) {
    args.push_back("--set");
    args.push_back(std::string("k").append(std::to_string(i)).append("=1"));
  }
  const Outcome r = pbf::test::pbf(args, folder.path());
  CHECK(r.code == 2);
  CHECK(has(r.err, "--set k0=1: k0: unknown key"));
  CHECK(has(r.err, "... and 9900 more problems"));
}
