// pbf run with time.adaptive: what is logged, written twice, or lost; and --resume.
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// A dam break with one iteration and a step that the guard stops (in second order only with an sor
/// above its default, 0.64); frames between the measures. Alarms and criteria change the step on
/// the way.
std::string write_adaptive(const Scratch& folder, const std::string& adaptive) {
  return folder.write("s.yaml",
                      "name: s\n"
                      "domain: {min: [0, 0, 0], max: [1.2, 0.4, 0.8], loads: true}\n"
                      "fluid: {spacing: 0.05}\n"
                      "bodies: [{shape: block, min: [0, 0, 0], max: [0.5, 0.4, 0.6]}]\n"
                      "gravity: [0, 0, -10]\n"
                      "time: {step: 0.02, end: 3.2, adaptive: " +
                          adaptive +
                          "}\n"
                          "solver: {iterations: 1, sor: 0.75}\n"
                          "measure_every: 5\n"
                          "output: {every: 0.06}\n");
}

/// Only alarms change the step; the criteria allow any.
const char* const kAlarms = "{cfl: 100, force: 100}";

std::string difference(const Scratch& folder) {
  return run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf");
}

}  // namespace

TEST_CASE("a run that the guard stops goes on with time.adaptive, and says what it did", "[slow]") {
  const Scratch folder;
  write_adaptive(folder, "off");
  REQUIRE(run_scene(folder, "fixed").code == 3);
  write_adaptive(folder, GENERATE(as<std::string>{}, "on", kAlarms));
  const Outcome o = run_scene(folder, "a");
  CAPTURE(o.err, o.out);
  REQUIRE(o.code == 0);
  const std::string log = read_text(folder / "a/log.txt");
  const int changes = count(log, " s (was ");
  CHECK(changes >= 1);
  CHECK(has(o.out, "time step           " + std::to_string(changes) + " changes, shortest 0.0"));
  CHECK(has(o.out, " % of the updates"));
  // The steps of the measures: halves of time.step, and only of good ones.
  const pbf::RunReader reader((folder / "a/run.vtkhdf").string());
  const auto dt = reader.log_column("dt"), updates = reader.log_column("update");
  REQUIRE(updates.size() == 33);
  bool halved = false;
  for (std::size_t k = 0; k < dt.size(); ++k) {
    CHECK(updates[k] == 5 * double(k));
    const double level = std::log2(0.02 / dt[k]);
    CHECK(level == std::floor(level));
    halved = halved || level > 0;
  }
  CHECK(halved);
  for (const double e : reader.log_column("energy")) CHECK(e < 1.1 * 1.25 * 360);
  // Every frame once, at its time.
  const auto times = reader.times();
  REQUIRE(times.size() == 55);
  for (std::size_t k = 0; k + 1 < times.size(); ++k) CHECK(times[k] == Approx(0.06 * double(k)));
  CHECK(times.back() == Approx(3.2));
}

TEST_CASE("an adaptive run stopped again and again ends in the bytes of the undisturbed run",
          "[slow]") {
  const Scratch folder;
  write_adaptive(folder, GENERATE(as<std::string>{}, "{step_min: 0.0003}", kAlarms));
  const std::string guard = GENERATE("guard={}", "guard=off");
  REQUIRE(run_scene(folder, "a", {"--set", guard}).code == 0);
  int stops = 0, code = 75;
  double limit = 0.03;  // s, longer every time: the end comes on any machine
  while (code == 75 && stops < 60) {
    const Outcome o = run_scene(
        folder, "b", {"--set", guard, "--resume", "--max-walltime", std::to_string(limit)});
    limit += 0.02;
    CAPTURE(o.err);
    code = o.code;
    REQUIRE((code == 75 || code == 0));
    stops += code == 75;
  }
  CHECK(code == 0);
  CHECK(difference(folder) == "");
  // The summary of the last process counts the whole run.
  const auto steps = [&](const std::string& out) {
    const std::string log = read_text(folder / (out + "/log.txt"));
    const std::size_t at = log.rfind("time step ");
    return log.substr(at, log.find("\ntime  ", at) - at);
  };
  CHECK(steps("a") == steps("b"));
}

TEST_CASE("a killed adaptive run ends in the same bytes, a prolonged one in those of the long one",
          "[slow]") {
  const Scratch folder;
  write_adaptive(folder, kAlarms);
  const Args set{"--resume", "--set", "checkpoint.every=0.001"};
  REQUIRE(run_scene(folder, "a", set).code == 0);
  SECTION("killed") {
    for (int k = 0; k < 3; ++k) {
      Args args{"run", "s.yaml", "--out", "b", "--threads", "1", "--quiet"};
      args.insert(args.end(), set.begin(), set.end());
      Process p(args, folder.path());
      std::this_thread::sleep_for(std::chrono::milliseconds(60 + 30 * k));
      p.send(SIGKILL);
      p.wait();
    }
    REQUIRE(run_scene(folder, "b", set).code == 0);
    CHECK(difference(folder) == "");
  }
  SECTION("prolonged from ends at a measure, at a frame, and at neither") {
    for (const char* end : {"0.2", "0.24", "0.22", "0.46", "1.02"}) {
      CAPTURE(end);
      Args first = set;
      first.insert(first.end(), {"--set", std::string("time.end=") + end});
      REQUIRE(run_scene(folder, "b", first).code == 0);
      REQUIRE(run_scene(folder, "b", set).code == 0);
      CHECK(difference(folder) == "");
      fs::remove_all(folder / "b");
    }
  }
}

TEST_CASE("with the shortest step the guard ends an adaptive run, with a scene that repeats it") {
  const Scratch folder;
  write_adaptive(folder, "{cfl: 100, force: 100, step_min: 0.01}");
  const Outcome o = run_scene(folder, "a", {"--set", "tensile.k=1000"});
  CHECK(o.code == 3);
  CHECK(has(o.err, "with the shortest step, 0.01 s (time.adaptive.step_min)"));
  CHECK(has(o.out, "1 times back to the last good state"));
  CHECK(pbf::RunReader((folder / "a/run.vtkhdf").string()).status() == "diverged");
  const std::string again = read_text(folder / "a/guard_scene.yaml");
  CHECK(has(again, "step: 0.01\n"));
  CHECK(has(again, "adaptive: off"));
  CHECK(has(again, "k: 250\n"));
  const Outcome repeated =
      pbf::test::pbf({"run", "a/guard_scene.yaml", "--out", "c"}, folder.path());
  CHECK(repeated.code == 3);
  const auto told = [](const std::string& text) {
    return text.substr(text.find(", in stage"), 28);
  };
  CHECK(told(o.err) == told(repeated.err));
}

TEST_CASE("of an adaptive run the guard is part of what may not change") {
  const Scratch folder;
  write_adaptive(folder, "on");
  REQUIRE(run_scene(folder, "a", {"--max-walltime", "0.02"}).code == 75);
  for (const auto& [set, text] : std::vector<std::pair<std::string, std::string>>{
           {"guard.energy=0.3", "guard.energy: auto before, 0.3 now"},
           {"guard=off", "guard: on before, off now"},
           {"time.adaptive=off", "time.adaptive: on before, off now"},
           {"time.adaptive.cfl=0.3", "time.adaptive.cfl: 0.4 before, 0.3 now"}}) {
    const Outcome o = run_scene(folder, "a", {"--resume", "--set", set});
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(has(o.err, text));
  }
}

TEST_CASE("the plan names the steps of an update, a study refuses them, compare leaves them out") {
  const Scratch folder;
  write_adaptive(folder, "{step_min: 0.004}");
  const Outcome plan = pbf::test::pbf({"plan", "s.yaml"}, folder.path());
  CHECK(has(plan.out, "passes of one step; 2^k of them in an update at level k = 0 ... 2"));
  CHECK_FALSE(has(plan.out, "halving of the step"));
  const Outcome off =
      pbf::test::pbf({"plan", "s.yaml", "--set", "time.adaptive=off"}, folder.path());
  CHECK(has(off.out, "passes of one update"));
  CHECK(has(off.out, "halving of the step: no key time.adaptive"));
  folder.write("study.yaml", "scene: s.yaml\ngrid:\n  - {solver.iterations: [1, 2]}\n");
  const Outcome study = pbf::test::pbf({"study", "study.yaml"}, folder.path());
  CHECK(study.code == 2);
  CHECK(has(study.err, "time.adaptive: a study compares steps that stay"));
  const Outcome compare = pbf::test::pbf(
      {"compare", "s.yaml", "--between", "cpu:float@1,cpu:float@2", "--updates", "2"},
      folder.path());
  CHECK(compare.code == 0);
  CHECK(has(compare.out, "time.adaptive is left out: every update is one step"));
}
