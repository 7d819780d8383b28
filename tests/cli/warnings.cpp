// Warnings of runs: where they are told, counted and kept, and --strict.
#include <sstream>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// A scene with frames whose step squeezes the fluid.
std::string squeezed(const std::string& more = "") {
  return "name: squeezed\n"
         "domain: {min: [0, 0, 0], max: [0.4, 0.4, 0.8]}\n"
         "fluid: {spacing: 0.05}\n"
         "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}]\n"
         "time: {step: 0.04, end: 4, order: 1}\n"
         "measure_every: 5\n"
         "output: {every: 0.4}\n" +
         more;
}

/// Fluid that runs out at one side.
const char* const kOpen =
    "name: open\n"
    "domain: {min: [0, 0, 0], max: [0.5, 0.4, 0.8], open: [x_max]}\n"
    "fluid: {spacing: 0.05}\n"
    "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}]\n"
    "time: {step: 0.002, end: 0.4}\n";

Outcome run(const Scratch& folder, const Args& more) {
  Args args{"run"};
  args.insert(args.end(), more.begin(), more.end());
  return pbf::test::pbf(args, folder.path());
}

std::vector<std::string> warnings_in(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("pbf: warning: ", 0) == 0) out.push_back(line.substr(14));
  return out;
}

std::vector<std::string> kept(const fs::path& file) {
  return pbf::RunReader(file.string()).info().warnings;
}

}  // namespace

TEST_CASE("a warning is on stderr, also with --quiet, in log.txt and in the run file") {
  const Scratch folder;
  folder.write("s.yaml", squeezed());
  const Outcome o = run(folder, {"s.yaml", "--out", "a", "--quiet"});
  CHECK(o.code == 0);
  const std::vector<std::string> told = warnings_in(o.err);
  // The step; three kinds on the way, and two of them, with other figures, again at the end.
  REQUIRE(told.size() == 6);
  CHECK(has(told[0], "times the longest that is safe"));
  CHECK(has(o.err, "pbf: warning: the fluid is compressed as no liquid is"));
  CHECK(has(o.err, "pbf: warning: the fluid has gained "));
  CHECK(warnings_in(read_text(folder / "a/log.txt")) == told);
  CHECK(has(o.out, "warning") == false);  // stdout is for results
  const std::vector<std::string> list = kept(folder / "a/run.vtkhdf");
  REQUIRE(list.size() == 4);  // each kind once, with the figures of the whole run
  CHECK(has(list[0], "times the longest that is safe"));
  CHECK(has(list[1], "at the end"));
  CHECK(has(list[2], "more than 1 %: the method adds it"));
  CHECK(has(list[3], "fluid may have passed through fluid"));
  CHECK(list[3] == told.back());
}

TEST_CASE("a sound run warns of nothing") {
  const Scratch folder;
  folder.write("s.yaml", squeezed());
  const Outcome o = run(folder, {"s.yaml", "--out", "a", "--set", "time.step=0.002", "--set",
                                 "time.end=0.4", "--strict"});
  CHECK(o.code == 0);
  CHECK(warnings_in(o.err).empty());
  CHECK(kept(folder / "a/run.vtkhdf").empty());
  CHECK(fs::exists(folder / "a/DONE"));
}

TEST_CASE("levels that stir still water are named with what calms it", "[slow]") {
  const Scratch folder;
  const std::string tank = std::string(PBF_SOURCE_DIR) + "/configs/stiff/tank.yaml";
  Args args{tank, "--quiet", "--out", "a", "--set", "domain.max=[0.5,0.01,0.4]"};
  for (const char* set : {"bodies[0].max=[0.5,0.01,0.2]", "solver.iterations=8", "solver.levels=on",
                          "solver.hyperviscosity=0", "time.end=1.5"})
    args.insert(args.end(), {"--set", set});
  const Outcome o = run(folder, args);
  CHECK(o.code == 0);
  CHECK(has(o.err, "pbf: warning: solver.levels stir the fluid: its energy is "));
  CHECK(has(o.err, "a larger solver.hyperviscosity"));
  args[3] = "b";
  args.insert(args.end(), {"--set", "solver.levels=off", "--strict"});
  CHECK(run(folder, args).code == 0);
}

TEST_CASE("pbf plan tells the warnings of a scene, as text and as JSON") {
  const Scratch folder;
  folder.write("s.yaml", squeezed());
  const Outcome text = pbf::test::pbf({"plan", "s.yaml"}, folder.path());
  CHECK(text.code == 0);
  CHECK(has(text.out, "\nwarnings\n  time.step 0.04 makes "));
  const Outcome json = pbf::test::pbf({"plan", "s.yaml", "--json"}, folder.path());
  CHECK(has(json.out, "\"warnings\":[{\"kind\":\"step\",\"text\":\"time.step 0.04 makes "));
  const Outcome sound =
      pbf::test::pbf({"plan", "s.yaml", "--json", "--set", "time.step=0.002"}, folder.path());
  CHECK(has(sound.out, "\"warnings\":[]"));
}

TEST_CASE("a strict run refuses a scene that warns before anything is made") {
  const Scratch folder;
  folder.write("s.yaml", squeezed());
  const Outcome o = run(folder, {"s.yaml", "--out", "a", "--strict"});
  CHECK(o.code == 6);
  CHECK(has(o.err, "pbf: error: --strict: time.step 0.04 makes"));
  // What is wrong with the command comes first.
  CHECK(run(folder, {"s.yaml", "--out", "a", "--strict", "--log-json", "none/x"}).code == 5);
  CHECK(!fs::exists(folder / "a"));
  fs::create_directory(folder / "b");
  folder.write("b/guard_scene.yaml", squeezed());
  folder.write("b/log.txt", "pbf");
  const Args replaced{"b/guard_scene.yaml", "--out", "b", "--strict", "--overwrite"};
  CHECK(run(folder, replaced).code == 2);
}

TEST_CASE("a strict run ends where it begins to warn, and without it the run goes on") {
  const Scratch folder;
  folder.write("s.yaml", std::string(kOpen) + "output: {every: 0.02}\n");
  const Outcome o = run(folder, {"s.yaml", "--out", "a", "--strict"});
  CHECK(o.code == 6);
  CHECK(has(o.err, "pbf: error: --strict: "));
  CHECK(has(o.err, "open face (x_max)"));
  CHECK(has(o.err, "--resume and without --strict"));
  CHECK(!fs::exists(folder / "a/DONE"));
  const std::int64_t there = pbf::RunReader((folder / "a/run.vtkhdf").string()).frames();
  CHECK((there > 1 && there < 20));
  CHECK(pbf::RunReader((folder / "a/run.vtkhdf").string()).status() == "stopped");
  REQUIRE(run(folder, {"s.yaml", "--out", "a", "--resume"}).code == 0);
  REQUIRE(run(folder, {"s.yaml", "--out", "b"}).code == 0);
  CHECK(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
  CHECK(kept(folder / "a/run.vtkhdf") == kept(folder / "b/run.vtkhdf"));
}

TEST_CASE("fluid that leaves through an open face is counted also without frames") {
  const Scratch folder;
  folder.write("s.yaml", kOpen);
  const Outcome o = run(folder, {"s.yaml", "--out", "a"});
  CHECK(o.code == 0);
  const std::vector<std::string> told = warnings_in(o.err);
  REQUIRE(told.size() == 1);
  CHECK(has(told[0], " of 512 particles ("));
  CHECK(has(told[0], "open face (x_max)"));
  const Outcome strict = run(folder, {"s.yaml", "--out", "b", "--strict"});
  CHECK(strict.code == 6);  // found at the end alone, and no run that is done
  CHECK(!fs::exists(folder / "b/DONE"));
}

TEST_CASE("a stopped run counts what it has warned of on from its checkpoint") {
  const Scratch folder;
  // Squeezed at the start alone: one iteration, and a wave that comes to rest.
  folder.write("s.yaml", squeezed("solver: {iterations: 2}\ncheckpoint: {every: 1000}\n"));
  REQUIRE(run(folder, {"s.yaml", "--out", "a", "--max-walltime", "0.001"}).code == 75);
  REQUIRE(run(folder, {"s.yaml", "--out", "a", "--resume"}).code == 0);
  REQUIRE(run(folder, {"s.yaml", "--out", "b"}).code == 0);
  CHECK(kept(folder / "a/run.vtkhdf") == kept(folder / "b/run.vtkhdf"));
  CHECK(kept(folder / "a/run.vtkhdf").size() == 4);
}

TEST_CASE("summary.csv counts the warnings of each run, and --strict makes them failures") {
  const Scratch folder;
  folder.write("s.yaml", squeezed());
  const Args base{"batch", "s.yaml", "--grid", "time.step=0.002,0.04", "--set", "time.end=0.4"};
  REQUIRE(pbf::test::pbf(base, folder.path()).code == 0);
  std::istringstream lines(read_text(folder / "out/batch_s/summary.csv"));
  std::string units, head, sound, bad;
  std::getline(lines, units), std::getline(lines, head), std::getline(lines, sound),
      std::getline(lines, bad);
  REQUIRE(head.ends_with(",particles,frames,warnings,seconds"));
  const auto warnings = [](std::string row) {
    row.resize(row.rfind(','));
    return std::stoi(row.substr(row.rfind(',') + 1));
  };
  CHECK(warnings(sound) == 0);
  CHECK(warnings(bad) == 4);
  Args strict = base;
  strict.insert(strict.end(), {"--strict", "--out", "strict"});
  const Outcome o = pbf::test::pbf(strict, folder.path());
  CHECK(o.code == 6);
  CHECK(has(o.err, "warned: --strict: time.step 0.04 makes"));
  CHECK(has(pbf::test::pbf({"batch", "s.yaml", "--strict", "--slurm"}, folder.path()).out,
            " --strict"));
}

TEST_CASE("fluid that an obstacle has closed in is told, while the run goes on and at its end") {
  const Scratch folder;
  folder.write("s.yaml",
               "name: press\n"
               "domain: {min: [0, 0, 0], max: [0.4, 0.4, 1]}\n"
               "fluid: {spacing: 0.05}\n"
               "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}]\n"
               "obstacles: [{name: press, shape: box, min: [-2, -1, 1], max: [2, 1, 4],\n"
               "             motion: {kind: velocity, velocity: [0, 0, -1]}}]\n"
               "time: {step: 0.004, end: 1.1}\n"
               "output: {every: 0.1}\n");
  const Outcome o = run(folder, {"s.yaml", "--out", "a", "--quiet"});
  CHECK(o.code == 0);
  std::vector<std::string> told;
  for (const std::string& w : warnings_in(o.err))
    if (has(w, "an obstacle leaves fluid no way out")) told.push_back(w);
  REQUIRE_FALSE(told.empty());
  CHECK(has(told.back(), ": a particle is 1.1 m behind its surface"));  // the diagonal of the box
  const auto all = kept(folder / "a/run.vtkhdf");
  CHECK(std::count(all.begin(), all.end(), told.back()) == 1);
  const Outcome early = run(folder, {"s.yaml", "--out", "b", "--quiet", "--set", "time.end=0.3"});
  CHECK_FALSE(has(early.err, "no way out"));
}
