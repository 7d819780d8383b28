// Runs with periodic axes as a user makes them: threads, resume, compare, warnings.
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;

namespace {

/// Two bodies that meet at the faces of a tank without side walls; above the size at which loops
/// run on several threads.
std::string meeting(const Scratch& folder, const std::string& more = {}) {
  return folder.write("s.yaml",
                      "domain: {min: [-1, 0, 0], max: [-0.6, 0.2, 0.4], periodic: [x, y], loads: "
                      "true}\n"
                      "fluid: {spacing: 0.02}\n"
                      "bodies:\n"
                      "  - {shape: block, min: [-1, 0, 0], max: [-0.6, 0.2, 0.1]}\n"
                      "  - {shape: block, min: [-0.9, 0.04, 0.14], max: [-0.7, 0.16, 0.3],\n"
                      "     velocity: [2, 1, -1]}\n"
                      "viscosity: {xsph: 0.05}\n"
                      "vorticity: {}\n"
                      "time: {step: 0.002, end: 0.2}\n"
                      "measure_every: 7\n"
                      "output: {every: 0.01}\n" +
                          more);
}
Outcome run_meeting(const Scratch& folder, const std::string& out, Args more = {}) {
  more.insert(more.begin(), {"run", "s.yaml", "--quiet", "--out", out});
  return pbf::test::pbf(more, folder.path());
}
std::string runs_differ(const Scratch& folder, const std::string& a, const std::string& b) {
  return run_difference(folder / (a + "/run.vtkhdf"), folder / (b + "/run.vtkhdf"));
}

}  // namespace

TEST_CASE("a periodic run has the same bytes with other threads, and when it is prolonged",
          "[slow]") {
  const Scratch folder;
  const std::string more = GENERATE("", "solver: {substeps: 2, iterations: 2}\n");
  meeting(folder, more);
  for (const char* threads : {"1", "2"}) {
    const Outcome o = run_meeting(folder, threads, {"--threads", threads});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
  }
  CHECK(runs_differ(folder, "1", "2") == "");
  REQUIRE(run_meeting(folder, "b", {"--set", "time.end=0.113"}).code == 0);
  const Outcome o = run_meeting(folder, "b", {"--resume"});
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK(runs_differ(folder, "1", "b") == "");
}

TEST_CASE("adaptive steps of a periodic run go back and on to the same bytes", "[slow]") {
  const Scratch folder;
  meeting(folder);
  const Args adaptive{"--set", "time.adaptive={}", "--set", "time.step=0.01"};
  Args shorter = adaptive, again = adaptive;
  shorter.insert(shorter.end(), {"--set", "time.end=0.1"});
  again.push_back("--resume");
  REQUIRE(run_meeting(folder, "a", adaptive).code == 0);
  REQUIRE(run_meeting(folder, "b", shorter).code == 0);
  REQUIRE(run_meeting(folder, "b", again).code == 0);
  CHECK(runs_differ(folder, "a", "b") == "");
}

TEST_CASE("frames of a periodic run are inside its domain", "[slow]") {
  const Scratch folder;
  meeting(folder);
  REQUIRE(run_meeting(folder, "a").code == 0);
  pbf::RunReader reader((folder / "a/run.vtkhdf").string());
  REQUIRE(reader.frames() == 21);
  bool moved = false;
  float first = 0;
  for (std::int64_t k = 0; k < reader.frames(); ++k) {
    const pbf::Snapshot s = reader.frame(k);
    const auto x = s.find("position")->as<float>();
    REQUIRE(x.size() == 3 * std::size_t(s.count));
    for (std::size_t i = 0; i < x.size(); i += 3) {
      CHECK((x[i] >= -1.f && x[i] <= -0.6f));
      CHECK((x[i + 1] >= 0.f && x[i + 1] <= 0.2f));
    }
    const float last = x[x.size() - 3];  // of the body that flies, which comes round
    moved = moved || (k > 0 && last < first);
    first = last;
  }
  CHECK(moved);
}

TEST_CASE("compare: a periodic scene in double and in float differs by rounding alone", "[slow]") {
  const Scratch folder;
  meeting(folder);
  const Outcome o = pbf::test::pbf({"compare", "s.yaml", "--between", "cpu:double,cpu:float",
                                    "--updates", "20", "--warmup", "60", "--members", "3"},
                                   folder.path());
  CAPTURE(o.out, o.err);
  CHECK(o.code == 0);
  CHECK(has(o.out, "frozen step: same"));
}

TEST_CASE("a lattice that leaves a seam at a periodic face gives a warning with what fits") {
  const Scratch folder;
  folder.write("s.yaml",
               "domain: {min: [0, 0, 0], max: [0.43, 0.4, 0.4], periodic: [x, y]}\n"
               "fluid: {spacing: 0.04}\n"
               "bodies: [{shape: block, min: [0, 0, 0], max: [0.43, 0.4, 0.2]}]\n"
               "time: {step: 0.002, end: 0.01}\n");
  Outcome o = pbf::test::pbf({"plan", "s.yaml"}, folder.path());
  CHECK(o.code == 0);
  CHECK(has(o.out, "10.75 fluid.spacing long along the periodic axis x"));
  CHECK(has(o.out, "give a length of 0.44 m (11 spacings), or fluid.spacing 0.03909"));
  o = pbf::test::pbf({"plan", "s.yaml", "--set", "domain.max=[0.44, 0.4, 0.4]", "--set",
                      "bodies[0].max=[0.44, 0.4, 0.2]"},
                     folder.path());
  CHECK_FALSE(has(o.out, "seam"));
}
