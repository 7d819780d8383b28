// Scenes that build on others, through every command that reads scenes.
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// base/common.yaml, and my.yaml on it.
struct OnBase {
  Scratch folder;
  OnBase() {
    fs::create_directories(folder / "base");
    common(0.1, 0.02);
    folder.write("my.yaml", "base: base/common.yaml\nname: mine\nsolver: {iterations: 2}\n");
  }
  void common(double spacing, double end, const std::string& more = "") const {
    folder.write(
        "base/common.yaml",
        "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: " + std::to_string(spacing) +
            "}\nbodies:\n  - {shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}\n"
            "time: {step: 0.005, end: " +
            std::to_string(end) + "}\noutput: {every: 0.02}\n" + more);
  }
  Outcome operator()(const Args& args) const { return pbf::test::pbf(args, folder.path()); }
};

}  // namespace

TEST_CASE("base: a run keeps the whole scene, and goes on while the chain says the same") {
  const OnBase pbf;
  REQUIRE(pbf({"run", "my.yaml", "--out", "o", "--quiet"}).code == 0);
  const std::string resolved = read_text(pbf.folder / "o/scene.resolved.yaml");
  CHECK(has(resolved, "spacing: 0.1\n"));
  CHECK(has(resolved, "iterations: 2\n"));
  CHECK_FALSE(has(resolved, "base"));
  CHECK(pbf({"plan", "my.yaml", "--resolved"}).out == resolved);
  // From what it stored, wherever the base is now.
  CHECK(pbf({"plan", "o/run.vtkhdf", "--resolved"}).out == resolved);
  pbf.common(0.1, 0.02, "# a comment\n");
  const Outcome same = pbf({"run", "my.yaml", "--out", "o", "--resume"});
  CHECK(same.code == 0);
  CHECK(has(same.err, "the run is finished"));
  pbf.common(0.1, 0.04);
  CHECK(pbf({"run", "my.yaml", "--out", "o", "--resume", "--quiet"}).code == 0);
  CHECK(has(read_text(pbf.folder / "o/scene.resolved.yaml"), "end: 0.04\n"));
  pbf.common(0.08, 0.04);
  const Outcome other = pbf({"run", "my.yaml", "--out", "o", "--resume", "--quiet"});
  CHECK(other.code == 2);
  CHECK(has(other.err, "cannot resume: fluid.spacing: 0.1 before, 0.08 now"));
  fs::remove_all(pbf.folder / "base");
  CHECK(pbf({"run", "o/run.vtkhdf", "--out", "again", "--quiet"}).code == 0);
  const Outcome gone = pbf({"run", "my.yaml", "--out", "o2", "--quiet"});
  CHECK(gone.code == 2);
  CHECK(has(gone.err, "my.yaml:1:7: base: base/common.yaml is not there (looked for /"));
  CHECK_FALSE(fs::exists(pbf.folder / "o2"));
}

TEST_CASE("base: settings and grids come after it, in every command", "[slow]") {
  const OnBase pbf;
  CHECK(has(pbf({"plan", "my.yaml", "--set", "fluid.spacing=0.05", "--resolved"}).out,
            "spacing: 0.05\n"));
  const Outcome batch = pbf({"batch", "my.yaml", "--grid", "solver.iterations=1,3", "--set",
                             "time.end=0.01", "--out", "b", "--quiet"});
  CHECK(batch.code == 0);
  CHECK(has(read_text(pbf.folder / "b/my_iterations=3/scene.resolved.yaml"), "iterations: 3\n"));
  CHECK(pbf({"batch", "my.yaml", "--grid", "solver.iterations=1,3", "--set", "time.end=0.01",
             "--out", "b", "--collect"})
            .code == 0);
  const Args sides{
      "--between", "cpu:float@1,cpu:float@2", "--warmup", "1", "--updates", "2", "--members", "2",
      "--quiet"};
  for (const char* input : {"my.yaml", "b/my_iterations=3/run.vtkhdf"}) {
    Args args{"compare", input};
    args.insert(args.end(), sides.begin(), sides.end());
    CAPTURE(input);
    CHECK(pbf(args).code == 0);
    CHECK(pbf({"bench", input, "--n", "60", "--warmup", "0", "--updates", "1", "--repeats", "1"})
              .code == 0);
  }
  pbf.folder.write("study.yaml",
                   "scene: my.yaml\ngrid: [{solver.iterations: [1, 2]}]\nrepeats: 1\nset: "
                   "{output: off}\n");
  CHECK(pbf({"study", "study.yaml", "--out", "st", "--quiet"}).code == 0);
  pbf.folder.write("suite.yaml",
                   "cases:\n  - {name: a, group: g, scene: my.yaml, must: {speed: 100}}\n");
  CHECK(pbf({"stability", "--suite", "suite.yaml", "--quiet"}).code == 0);
  CHECK(pbf({"stability", "my.yaml", "--map", "time.step,gravity", "--x", "0.002,0.004", "--y", "5",
             "--iterations", "2", "--quiet"})
            .code == 0);
  const Outcome set = pbf({"plan", "my.yaml", "--set", "base=base/common.yaml"});
  CHECK(set.code == 2);
  CHECK(has(set.err, "--set base=base/common.yaml: base: is read with the scene file"));
  CHECK(pbf({"batch", "my.yaml", "--grid", "base=a.yaml,b.yaml", "--out", "x"}).code == 2);
}

TEST_CASE("base: outside the scene's folder it needs --base-folder, in every command", "[slow]") {
  const OnBase pbf;
  fs::create_directories(pbf.folder / "deep");
  pbf.folder.write("deep/d.yaml", "base: ../my.yaml\nname: d\noutput: off\n");
  pbf.folder.write("study.yaml",
                   "scene: deep/d.yaml\ngrid: [{solver.iterations: [1, 2]}]\nrepeats: 1\n");
  pbf.folder.write("suite.yaml",
                   "cases:\n  - {name: a, group: g, scene: deep/d.yaml, must: {speed: 100}}\n");
  const std::vector<Args> commands{
      {"plan", "deep/d.yaml"},
      {"run", "deep/d.yaml", "--quiet", "--overwrite"},
      {"batch", "deep/d.yaml", "--out", "b", "--quiet"},
      {"study", "study.yaml", "--out", "st", "--quiet"},
      {"stability", "deep/d.yaml", "--map", "time.step,gravity", "--x", "0.002", "--y", "5",
       "--iterations", "2", "--quiet"},
      {"stability", "--suite", "suite.yaml", "--quiet"},
      {"compare", "deep/d.yaml", "--between", "cpu:float@1,cpu:float@2", "--warmup", "1",
       "--updates", "2", "--members", "2", "--quiet"},
      {"bench", "deep/d.yaml", "--n", "60", "--warmup", "0", "--updates", "1", "--repeats", "1"}};
  for (Args args : commands) {
    CAPTURE(args);
    const Outcome refused = pbf(args);
    CHECK(refused.code == (args[1] == "--suite" ? 6 : 2));
    CHECK(has(refused.err + refused.out, "lies outside"));
    args.insert(args.end(), {"--base-folder", "."});
    CHECK(pbf(args).code == 0);
  }
  CHECK(has(pbf({"batch", "deep/d.yaml", "--base-folder", ".", "--slurm"}).out, "--base-folder /"));
  const Outcome none = pbf({"plan", "my.yaml", "--base-folder", "none"});
  CHECK(none.code == 2);
  CHECK(has(none.err, "--base-folder"));
}

TEST_CASE("base: no output takes the place of a file of the chain") {
  const OnBase pbf;
  const std::string before = read_text(pbf.folder / "base/common.yaml");
  const Outcome o =
      pbf({"bench", "my.yaml", "--n", "60", "--updates", "1", "--csv", "base/common.yaml"});
  CHECK(o.code == 2);
  CHECK(has(o.err, "which this command reads"));
  CHECK(read_text(pbf.folder / "base/common.yaml") == before);
  // What only looks the same is read: a FIFO would wait for its writer.
  CHECK(
      shell("mkfifo f.yaml; echo 'base: f.yaml' > s.yaml; \"$PBF\" plan s.yaml", pbf.folder.path())
          .code == 2);
}

TEST_CASE("plan: a run file is planned as its scene, other HDF5 files are refused") {
  const OnBase pbf;
  REQUIRE(pbf({"run", "my.yaml", "--out", "o", "--quiet"}).code == 0);
  const Outcome plan = pbf({"plan", "o/run.vtkhdf", "--set", "fluid.spacing=0.05"});
  CHECK(plan.code == 0);
  CHECK(has(plan.out, "512 particles"));
  CHECK(pbf({"plan", "o/run.vtkhdf"}).out == pbf({"plan", "my.yaml"}).out);
  pbf.folder.write("x.yaml", "base: o/run.vtkhdf\n");
  const Outcome as_base = pbf({"plan", "x.yaml"});
  CHECK(as_base.code == 2);
  CHECK(has(as_base.err,
            "o/run.vtkhdf (included from x.yaml:1): is an HDF5 file, expected a scene "
            "in YAML; of a run file pbf plan o/run.vtkhdf --resolved prints"));
  pbf.folder.write("bad.vtkhdf", std::string("\x89HDF\r\n\x1a\n\0\0", 10));
  CHECK(pbf({"plan", "bad.vtkhdf"}).code != 0);
  pbf.folder.write("s.yaml", "scene: o/run.vtkhdf\ngrid: [{solver.iterations: [1, 2]}]\n");
  const Outcome study = pbf({"study", "s.yaml"});
  CHECK(study.code == 2);
  CHECK(has(study.err, "is an HDF5 file, expected a scene in YAML"));
}
