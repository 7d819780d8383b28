// pbf run with gauges: their data in run.vtkhdf, when they are read, runs that stop and go on.
#include <algorithm>
#include <cmath>

#include "lib/io/h5_read.h"
#include "lib/io/run_file.h"
#include "lib/program/plan.h"
#include "lib/scene/load.h"
#include "tests/support/catch.h"
#include "tests/support/in_pieces.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;

namespace {

void write_gauge_scene(const Scratch& folder, const std::string& more = "") {
  folder.write("s.yaml",
               "name: s\n"
               "domain: {min: [0, 0, 0], max: [1, 0.6, 1]}\n"
               "fluid: {spacing: 0.05}\n"
               "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.6, 0.6]}]\n"
               "obstacles:\n"
               "  - {name: step, shape: box, min: [0.7, 0.2, 0], max: [0.9, 0.4, 0.2]}\n"
               "gauges:\n"
               "  - {name: H, kind: level, at: [0.2, 0.3]}\n"
               "  - {name: U, kind: velocity, at: [0.2, 0.3, 0.1]}\n"
               "  - {name: Q 1, kind: flow, center: [0.5, 0.3, 0.5], normal: [1, 0, 0],\n"
               "     size: [0.6, 1]}\n"
               "  - {name: P, kind: pressure, on: step, at: [0.7, 0.3, 0.1], radius: 0.1}\n"
               "  - {name: floor, kind: pressure, on: z_min, at: [0.2, 0.3, 0], radius: 0.15}\n"
               "time: {step: 0.002, end: 0.41}\n"
               "measure_every: 7\n"
               "output: {every: 0.02, gauges_every: 0.01}\n" +
                   more);
}

}  // namespace

TEST_CASE("a run with gauges writes their readings down when they are due") {
  const Scratch folder;
  write_gauge_scene(folder);
  REQUIRE(run_scene(folder, "a").code == 0);
  const pbf::RunReader reader((folder / "a/run.vtkhdf").string());
  auto there = reader.gauges();
  std::sort(there.begin(), there.end());
  CHECK(there == std::vector<std::string>{"H", "P", "Q 1", "U", "floor", "peak/P", "peak/floor",
                                          "time", "total/Q 1", "update"});
  const auto update = reader.gauge("update"), time = reader.gauge("time");
  REQUIRE(update.size() == 42);  // 205 updates
  for (std::size_t k = 0; k < update.size(); ++k) {
    CHECK(update[k] == double(5 * k));
    CHECK(time[k] == Approx(0.01 * double(k)));
  }
  CHECK(reader.gauge("U").size() == 3 * update.size());
  CHECK(reader.gauge("H")[0] == Approx(0.6).margin(0.005));
  CHECK(reader.gauge("H").back() < 0.5);
  CHECK(reader.gauge("P")[0] == 0);
  const auto floor = reader.gauge("floor"), peak = reader.gauge("peak/floor");
  for (std::size_t k = 1; k < floor.size(); ++k) CHECK(peak[k] >= floor[k] * (1 - 1e-12));
  // The total is the sum of the means times their intervals.
  const auto flow = reader.gauge("Q 1"), total = reader.gauge("total/Q 1");
  double sum = 0;
  for (std::size_t k = 1; k < flow.size(); ++k) {
    sum += flow[k] * (time[k] - time[k - 1]);
    CHECK(total[k] == Approx(sum).margin(1e-6));
  }
  CHECK(sum > 10);
  const auto columns = reader.log_columns();  // no loads were asked for
  CHECK(std::none_of(columns.begin(), columns.end(),
                     [](const std::string& c) { return c.rfind("load/", 0) == 0; }));
}

TEST_CASE("the plan knows the datasets of a run file to six, whatever is read") {
  const Scratch folder;
  write_gauge_scene(folder);
  const auto set = GENERATE(
      std::vector<std::string>{}, std::vector<std::string>{"--set", "gauges=[]"},
      std::vector<std::string>{"--set", "domain.loads=true", "--set", "domain.open=[z_max]",
                               "--set", "obstacles[0].loads=true", "--set", "guard=off"},
      std::vector<std::string>{"--set", "gauges=[]", "--set", "output.fields=[velocity]", "--set",
                               "viscosity={}", "--set", "vorticity={}", "--set",
                               "obstacles[0].motion={kind: velocity, velocity: [0.1, 0, 0]}"});
  std::vector<std::string> words{"--set", "time.end=0.03"};
  words.insert(words.end(), set.begin(), set.end());
  REQUIRE(run_scene(folder, "a", words).code == 0);
  const std::string path = (folder / "a/run.vtkhdf").string();
  const pbf::RunInfo info = pbf::RunReader(path).info();
  const pbf::Scene scene = pbf::parse_stored_scene(info.resolved_scene, "s", {});
  const pbf::h5::Reading file(path);
  CHECK(double(pbf::h5::datasets_below(file, 4).size()) ==
        Approx(pbf::run_file_datasets(pbf::make_plan(scene, info.particles), scene)).margin(6));
}

TEST_CASE("gauges are read with the measures by default, and at the end") {
  const Scratch folder;
  write_gauge_scene(folder);
  REQUIRE(run_scene(folder, "a", {"--set", "output.gauges_every=auto"}).code == 0);
  const pbf::RunReader reader((folder / "a/run.vtkhdf").string());
  CHECK(reader.gauge("update") == reader.log_column("update"));
  CHECK(reader.gauge("update").back() == 205);
}

TEST_CASE("a stopped run with gauges ends in the bytes of the undisturbed run", "[slow]") {
  const Scratch folder;
  const bool adaptive = GENERATE(false, true);
  write_gauge_scene(folder, "");
  std::vector<std::string> set{"--set", "time.end=0.8"};
  if (adaptive) set.insert(set.end(), {"--set", "time.step=0.01", "--set", "time.adaptive=on"});
  REQUIRE(run_scene(folder, "a", set).code == 0);
  run_in_pieces(folder, "b", 0.1, set);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
}

TEST_CASE("a finished run with gauges goes on to a later end as if it had not stopped", "[slow]") {
  const Scratch folder;
  write_gauge_scene(folder);
  const std::vector<std::string> keep{"--set", "checkpoint={}"};
  const auto run = [&](const char* out, const char* end, bool resume) {
    std::vector<std::string> words{"--set", "checkpoint={}", "--set",
                                   std::string("time.end=") + end};
    if (resume) words.push_back("--resume");
    return run_scene(folder, out, words).code;
  };
  REQUIRE(run("a", "0.33", false) == 0);
  REQUIRE(run("b", "0.124", false) == 0);  // between two readings
  REQUIRE(run("b", "0.33", true) == 0);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
}

TEST_CASE("a changed gauge is refused by --resume, and without output there is a warning") {
  const Scratch folder;
  write_gauge_scene(folder);
  REQUIRE(run_scene(folder, "b", {"--max-walltime", "0.02"}).code == 75);
  const Outcome o = run_scene(folder, "b", {"--resume", "--set", "gauges[0].at=[0.2, 0.31]"});
  CHECK(o.code == 2);
  CHECK(has(o.err, "gauges[0].at: [0.2, 0.3] before, [0.2, 0.31] now"));
  const Outcome none = run_scene(folder, "c", {"--set", "output=off", "--set", "time.end=0.02"});
  CHECK(none.code == 0);
  CHECK(has(read_text(folder / "c/log.txt"),
            "gauges are written to run.vtkhdf, and there is no "
            "key output"));
}

TEST_CASE("pbf plan says which gauges a scene does without, and why its levels are off") {
  const Scratch folder;
  write_gauge_scene(folder);
  const Outcome o = pbf::test::pbf({"plan", "s.yaml", "--set", "obstacles=[]", "--set",
                                    "gauges=[{name: f, kind: pressure, on: z_min, at: [0.2, 0.3, "
                                    "0], radius: 0.1}]",
                                    "--set", "solver.levels=auto"},
                                   folder.path());
  REQUIRE(o.code == 0);
  CHECK(has(o.out, "the scene has a pressure gauge on a wall"));
  const Outcome without = pbf::test::pbf({"plan", "s.yaml", "--set", "gauges=[]"}, folder.path());
  CHECK(has(without.out, "no key gauges"));
  const Outcome off =
      pbf::test::pbf({"plan", "s.yaml", "--set", "gauges[3].at=[0.67,0.3,0.1]"}, folder.path());
  CHECK(off.code == 2);
  CHECK(has(off.err,
            "gauges[3].at: is 0.03 m from the surface of step; a pressure gauge lies on it "
            "(nearest point (0.7, 0.3, 0.1))"));
}

TEST_CASE("the example of the page on scenes runs") {
  const std::string page = read_text(PBF_SOURCE_DIR "/configs/README.md");
  const std::size_t from = page.find("```yaml\n", page.find("## Gauges"));
  REQUIRE(from != std::string::npos);
  const Scratch folder;
  folder.write("s.yaml", page.substr(from + 8, page.find("```", from + 8) - from - 8));
  REQUIRE(run_scene(folder, "a", {"--set", "time.end=0.02"}).code == 0);
  const pbf::RunReader reader((folder / "a/run.vtkhdf").string());
  CHECK(reader.gauge("H2") == std::vector<double>{0, 0, 0});
  CHECK(std::isnan(reader.gauge("U")[0]));
  CHECK(reader.gauge("peak/P1").size() == 3);
  CHECK(reader.gauge("total/Q").size() == 3);
}
