// pbf compare as a user runs it: two run files, or one scene on two sides.
#include <fstream>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// Runs the tiny scene into `out`; the path of its run file.
std::string run_tiny(const Scratch& folder, const std::string& out,
                     std::vector<std::string> more = {}) {
  folder.write("tiny.yaml", tiny_scene());
  more.insert(more.begin(), {"run", "tiny.yaml", "--quiet", "--out", out});
  const Outcome o = pbf::test::pbf(more, folder.path());
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  return out + "/run.vtkhdf";
}

Outcome compare(const Scratch& folder, std::vector<std::string> args) {
  args.insert(args.begin(), "compare");
  return pbf::test::pbf(args, folder.path());
}

}  // namespace

TEST_CASE("compare: two runs of one scene are the same bytes, with other threads too") {
  const Scratch folder;
  const std::string a = run_tiny(folder, "a", {"--threads", "1"}),
                    b = run_tiny(folder, "b", {"--threads", "2"});
  const Outcome o = compare(folder, {a, b});
  CAPTURE(o.out, o.err);
  CHECK(o.code == 0);
  CHECK(has(o.out, "same to the last byte"));
  CHECK(has(o.out, "6 common frames"));
  CHECK(has(o.out, "scene: same"));
}

TEST_CASE("compare: float and double of one scene cannot be told apart as samples") {
  const Scratch folder;
  const std::string a = run_tiny(folder, "a"), b = run_tiny(folder, "b", {"--precision", "double"});
  const Outcome o = compare(folder, {a, b});
  CAPTURE(o.out, o.err);
  CHECK(o.code == 0);
  CHECK(has(o.out, "not judged"));
  CHECK(has(o.out, "no two samples can be told apart"));
}

TEST_CASE("compare: run files of other scenes, particles, frames or fields say what differs",
          "[slow]") {
  const Scratch folder;
  const std::string a = run_tiny(folder, "a");
  std::vector<std::string> key;
  std::vector<std::string> fragments;
  SECTION("another scene") {
    key = {"--set", "gravity=[0,0,-20]"};
    fragments = {"scene: DIFFERS\n  gravity: [0, 0, -9.81] in A, [0, 0, -20] in B\n"};
  }
  SECTION("other keys of blocks, and another step, are named with their blocks, and no other end") {
    key = {"--set", "time.step=0.004",           "--set", "solver.iterations=2",
           "--set", "bodies.0.velocity=[1,0,0]", "--set", "viscosity={}"};
    fragments = {"bodies[0].velocity: [0, 0, 0] in A, [1, 0, 0] in B",
                 "solver.iterations: 4 in A, 2 in B", "time.step: 0.005 in A, 0.004 in B",
                 "viscosity: off in A, on in B"};
  }
  SECTION("another number of particles") {
    key = {"--set", "bodies.0.max=[0.4,0.4,0.5]"};
    fragments = {"A holds 64 particles at 0 s, B 80"};
  }
  SECTION("another cadence") {
    key = {"--set", "output.every=0.05"};
    fragments = {"extent: DIFFERS", "4 frames of A have no frame of B", "first at 0.02 s",
                 "1 frame of B has no frame of A", "output.every is 0.02 s in A, 0.05 s in B"};
  }
  SECTION("a field missing") {
    key = {"--set", "output.fields=[velocity]"};
    fragments = {"only A has the field density, b/run.vtkhdf has not", "output.fields"};
  }
  SECTION("a shorter run") {
    key = {"--set", "time.end=0.05"};
    fragments = {"time.end is 0.1 s in A, 0.05 s in B", "3 frames of A", "the log ends at 0.1 s"};
  }
  SECTION("a run that ends after its first frame") {
    key = {"--set", "time.end=0.005"};
    fragments = {"5 frames of A have no frame of B", "the first at 0.02 s"};
  }
  key.insert(key.begin(), {"--precision", "float"});
  const Outcome o = compare(folder, {a, run_tiny(folder, "b", key)});
  CAPTURE(o.out, o.err);
  CHECK(o.code == 6);
  for (const auto& f : fragments) CHECK(has(o.out, f));
}

TEST_CASE("compare: shipped scenes in float and in double are the same", "[slow]") {
  const Scratch folder;
  std::vector<std::string> scene;
  // Densities of 1 +- rounding in frame 0; the flat top of a pool; flows that chaos has mixed.
  SECTION("minimal") { scene = {"minimal", "--set", "output={}", "--set", "time.end=0.1"}; }
  SECTION("tank") {
    scene = {"tank_at_rest", "--set", "fluid.spacing=0.04", "--set",
             "time.end=1",   "--set", "output={}"};
  }
  SECTION("double dam break") {
    scene = {"double_dam_break", "--set", "fluid.spacing=0.05", "--set",
             "time.end=2",       "--set", "render=off"};
  }
  for (const char* precision : {"float", "double"}) {
    std::vector<std::string> args{
        "run",     std::string(PBF_SOURCE_DIR) + "/configs/" + scene[0] + ".yaml",
        "--quiet", "--out",
        precision, "--precision",
        precision, "--threads",
        "1"};
    args.insert(args.end(), scene.begin() + 1, scene.end());
    REQUIRE(pbf::test::pbf(args, folder.path()).code == 0);
  }
  const Outcome o = compare(folder, {"float/run.vtkhdf", "double/run.vtkhdf"});
  CAPTURE(o.out, o.err);
  CHECK(o.code == 0);
  CHECK(has(o.out, "values up to 16 roundings apart are equal"));
}

TEST_CASE("compare: a run that was stopped differs until it is resumed") {
  const Scratch folder;
  const std::string a = run_tiny(folder, "a");
  const std::vector<std::string> again{"run", "tiny.yaml", "--quiet", "--out", "b"};
  std::vector<std::string> stopped = again, resumed = again;
  stopped.insert(stopped.end(), {"--max-walltime", "0.000001"});
  resumed.emplace_back("--resume");
  REQUIRE(pbf::test::pbf(stopped, folder.path()).code == 75);
  Outcome o = compare(folder, {a, "b/run.vtkhdf"});
  CAPTURE(o.out, o.err);
  CHECK(o.code == 6);
  CHECK(has(o.out, "A is finished, B is stopped (--max-walltime)"));
  REQUIRE(pbf::test::pbf(resumed, folder.path()).code == 0);
  o = compare(folder, {a, "b/run.vtkhdf"});
  CAPTURE(o.out, o.err);
  CHECK(o.code == 0);
  CHECK(has(o.out, "same to the last byte"));
  o = compare(folder, {a, a});
  CHECK(o.code == 0);
  CHECK(has(o.out, "A and B are one and the same file"));
}

TEST_CASE("compare: one scene on two sides, with reports") {
  const Scratch folder;
  const std::string scene = folder.write("tiny.yaml", tiny_scene());
  Outcome o = compare(folder, {scene, "--between", "cpu:double,cpu:float", "--updates", "10",
                               "--warmup", "5", "--members", "3", "--report", "r.json"});
  CAPTURE(o.out, o.err);
  CHECK(o.code == 0);
  CHECK(has(o.out, "frozen step: same"));
  CHECK(has(o.err, "update 10/10"));
  CHECK(fs::file_size(folder / "r.json") > 2000);
  o = compare(folder, {scene, "--between", "cpu:float@1,cpu:float@2", "--quiet", "--updates", "3",
                       "--set-b", "gravity=[0,0,-9.82]"});
  CHECK(o.code == 6);
  CHECK(o.err.empty());
  CHECK(has(o.out, "first in stage `predict`"));
  CHECK(has(o.out, "on B alone: gravity"));
}

TEST_CASE("compare: what cannot be compared gets its exit code and a message that names it") {
  const Scratch folder;
  const std::string a = run_tiny(folder, "a");
  const std::string scene = (folder / "tiny.yaml").string();
  const std::string whole = read_text(folder / a);
  folder.write("cut.h5", whole.substr(0, whole.size() / 2));
  folder.write("foreign.h5", "not HDF5 at all");
  fs::copy_file(folder / a, folder / "late.h5");
  struct Wrong {
    std::vector<std::string> args;
    int code;
    std::vector<std::string> fragments;
  };
  const std::vector<Wrong> cases{
      {{a, "none.h5"}, 5, {"none.h5"}},
      {{a, "foreign.h5"}, 5, {"foreign.h5"}},
      {{a, "cut.h5"}, 5, {"cut.h5"}},
      {{a, scene}, 5, {"tiny.yaml"}},
      {{a}, 2, {"two runs", "--between"}},
      {{a, a, a}, 2, {"two runs", "3 given"}},
      {{a, a, "--set", "time.end=1"}, 2, {"--set", "--between"}},
      {{a, a, "--report", "r.txt"}, 2, {"r.txt", "must end in .json"}},
      {{a, a, "--report", "r.html"}, 2, {"r.html", "pbf_tools plot-compare REPORT.json"}},
      {{scene, "--between", "cpu:double"}, 2, {"--between", "two sides"}},
      {{scene, "--between", "cpu:double,gpu:float"}, 2, {"gpu:float", "cuda"}},
      {{scene, "--between", "cpu:double,cpu+defect:float"}, 2, {"PBF_DEFECT"}},
      {{scene, a, "--between", "cpu:double,cpu:float"}, 2, {"one scene", "2 files"}},
      {{scene, "--between", "cpu:double,cuda:float"}, 4, {"--backend cpu"}},
      {{scene, "--between", "cpu:double,cpu:float", "--set-b", "fluid.spacing=0.05"},
       2,
       {"--set-b", "particles"}},
      {{scene, "--between", "cpu:double,cpu:float", "--updates", "0"}, 2, {"--updates"}},
      {{scene, "--between", "cpu:double,cpu:float", "--members", "1"}, 2, {"--members"}}};
  for (const Wrong& w : cases) {
    CAPTURE(w.args);
    const Outcome o = compare(folder, w.args);
    CAPTURE(o.out, o.err);
    CHECK(o.code == w.code);
    CHECK(o.err.find("pbf: error: ") != std::string::npos);
    for (const auto& f : w.fragments) CHECK(has(o.err, f));
  }
}
