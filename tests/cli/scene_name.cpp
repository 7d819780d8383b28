// Where runs of scenes go that say no name.
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// tiny_scene() without its name.
std::string unnamed() {
  std::string text = tiny_scene();
  const std::size_t at = text.find("name:");
  return at == std::string::npos ? text : text.erase(at, text.find('\n', at) + 1 - at);
}

std::string name_in(const fs::path& run) {
  return pbf::RunReader((run / "run.vtkhdf").string()).info().resolved_scene;
}

}  // namespace

TEST_CASE("two scenes without a name do not share a folder") {
  const Scratch folder;
  folder.write("tank.yaml", unnamed());
  folder.write("my pool.yaml", unnamed());
  REQUIRE(pbf::test::pbf({"run", "tank.yaml", "--quiet"}, folder.path()).code == 0);
  REQUIRE(pbf::test::pbf({"run", "my pool.yaml", "--quiet"}, folder.path()).code == 0);
  CHECK(fs::exists(folder / "out/tank/DONE"));
  CHECK(fs::exists(folder / "out/my-pool/DONE"));
  CHECK_FALSE(fs::exists(folder / "out/scene"));
  CHECK(has(name_in(folder / "out/tank"), "name: tank\n"));
  CHECK(has(pbf::test::pbf({"plan", "tank.yaml", "--json"}, folder.path()).out,
            "\"scene\":\"tank\""));
  // What comes by stdin is no file of its own.
  for (const char* line : {"\"$PBF\" run /dev/stdin --quiet --overwrite < tank.yaml",
                           "cat tank.yaml | \"$PBF\" run /dev/stdin --quiet --overwrite"}) {
    fs::remove_all(folder / "out/scene");
    CHECK(shell(line, folder.path()).code == 0);
    CHECK(fs::exists(folder / "out/scene/DONE"));
  }
}

TEST_CASE("two scenes on one base that has a name do not share a folder") {
  const Scratch folder;
  folder.write("base.yaml", "name: tank\n" + unnamed());
  folder.write("low.yaml", "base: base.yaml\nsolver: {iterations: 1}\n");
  folder.write("high.yaml", "base: base.yaml\nsolver: {iterations: 2}\n");
  for (const char* scene : {"low.yaml", "high.yaml"})
    CHECK(pbf::test::pbf({"run", scene, "--quiet"}, folder.path()).code == 0);
  CHECK(fs::exists(folder / "out/low/DONE"));
  CHECK(fs::exists(folder / "out/high/DONE"));
  CHECK_FALSE(fs::exists(folder / "out/tank"));
}

TEST_CASE("a run that was recorded under another name goes on, wherever its scene lies now") {
  const Scratch folder;
  folder.write("s.yaml", unnamed());
  const Args begin{"run", "s.yaml", "--out", "a", "--quiet", "--set", "name=scene"};
  Args stopped = begin;
  stopped.insert(stopped.end(), {"--max-walltime", "0.0001"});
  REQUIRE(pbf::test::pbf(stopped, folder.path()).code == 75);
  folder.write("tank.yaml", unnamed());
  const Outcome o =
      pbf::test::pbf({"run", "tank.yaml", "--out", "a", "--resume", "--quiet"}, folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 0);
  CHECK(fs::exists(folder / "a/DONE"));
}

TEST_CASE("a run file is repeated under the name that it was recorded under") {
  const Scratch folder;
  folder.write("s.yaml", unnamed());
  REQUIRE(pbf::test::pbf({"run", "s.yaml", "--out", "a", "--quiet", "--set", "name=scene"},
                         folder.path())
              .code == 0);
  fs::rename(folder / "a", folder / "moved");
  REQUIRE(pbf::test::pbf({"run", "moved/run.vtkhdf", "--quiet"}, folder.path()).code == 0);
  CHECK(fs::exists(folder / "out/scene/DONE"));
}

TEST_CASE("resume of a scene without a name tells of a run that lies in out/scene") {
  const Scratch folder;
  folder.write("tank.yaml", unnamed());
  REQUIRE(
      pbf::test::pbf({"run", "tank.yaml", "--out", "out/scene", "--quiet"}, folder.path()).code ==
      0);
  const Outcome o = pbf::test::pbf({"run", "tank.yaml", "--resume"}, folder.path());
  CHECK(o.code == 0);
  CHECK(has(o.err, "out/tank is not there: the run begins at its start; out/scene holds a run"));
  CHECK(has(o.err, "give --out out/scene"));
  CHECK(fs::exists(folder / "out/tank/DONE"));
  // Not once it is there, nor for a scene with a name.
  CHECK_FALSE(
      has(pbf::test::pbf({"run", "tank.yaml", "--resume"}, folder.path()).err, "out/scene"));
  folder.write("named.yaml", "name: mine\n" + unnamed());
  CHECK_FALSE(
      has(pbf::test::pbf({"run", "named.yaml", "--resume"}, folder.path()).err, "out/scene"));
}
