// Where scenes come from, and where their names lead to.
#include <cstdlib>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

TEST_CASE("a scene from a pipe is read whole") {
  const Scratch folder;
  // Longer than any buffer, and what matters comes first.
  const std::string text = tiny_scene() + "# " + std::string(100000, '-') + "\n";
  folder.write("s.yaml", "viscosity: {xsph: 0.125}\n" + text);
  const std::string command = "cd " + folder.path().string() + " && cat s.yaml | " + PBF_BINARY +
                              " run /dev/stdin --out o --quiet > summary.txt";
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK(has(read_text(folder / "o/scene.resolved.yaml"), "xsph: 0.125"));
}

TEST_CASE("no scene or study writes outside its folder by its name") {
  const Scratch folder;
  const std::string scene = folder.write("s.yaml", tiny_scene());
  const Outcome run = pbf::test::pbf({"run", scene, "--set", "name=../../evil"}, folder.path());
  CHECK(run.code == 2);
  CHECK(has(run.err, "give a word without slashes"));
  folder.write("study.yaml", "name: ../evil\nscene: s.yaml\ngrid: [{solver.iterations: [1, 2]}]\n");
  const Outcome study = pbf::test::pbf({"study", "study.yaml"}, folder.path());
  CHECK(study.code == 2);
  CHECK(has(study.err, "study.yaml:1:7: name: is \"../evil\""));
  CHECK_FALSE(fs::exists(folder / "out"));
}
