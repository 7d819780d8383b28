// pbf batch: which runs it makes, what it skips, and that being killed changes nothing.
#include <chrono>
#include <csignal>
#include <random>
#include <sstream>
#include <thread>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// A summary without its last column, the seconds; the folder of the batch is no part of it.
std::string summary(const fs::path& folder) {
  std::istringstream lines(read_text(folder / "summary.csv"));
  std::string all;
  for (std::string line; std::getline(lines, line);) all += line.substr(0, line.rfind(',')) + "\n";
  return all;
}

}  // namespace

TEST_CASE("a batch of 12 runs killed at random and rerun has the summary of the undisturbed one",
          "[slow]") {
  const Scratch folder;
  folder.write("s.yaml",
               "name: s\n"
               "domain: {min: [0, 0, 0], max: [1, 0.6, 1]}\n"
               "fluid: {spacing: 0.06}\n"
               "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.6, 0.6]}]\n"
               "time: {step: 0.002, end: 0.3}\n"
               "checkpoint: {every: 0.03}\n"
               "output: {every: 0.02}\n");
  std::vector<std::string> args{"batch",     "s.yaml",
                                "--jobs",    "3",
                                "--grid",    "solver.iterations=1,2,4",
                                "--grid",    "solver.kernels=consistent,paper",
                                "--grid",    "time.step=0.002,0.003",
                                "--threads", "1",
                                "--out"};
  auto undisturbed = args, killed = args;
  undisturbed.push_back("a");
  killed.push_back("b");
  const Outcome whole = pbf::test::pbf(undisturbed, folder.path());
  CAPTURE(whole.err);
  REQUIRE(whole.code == 0);
  CHECK(has(whole.out, "12 runs: 12 finished, 0 failed, 0 to go on with"));
  const auto seed = std::random_device{}();
  std::mt19937 random(seed);
  CAPTURE(seed);
  int kills = 0, code = -1;
  for (int round = 0; round < 60 && code != 0; ++round) {
    Process batch(killed, folder.path());
    if (kills < 6) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20 + random() % 250));
      batch.send(kills % 2 ? SIGTERM : SIGKILL);  // the runs of a killed batch get SIGTERM
    }
    code = batch.wait().code;
    if (code == 128 + SIGKILL || code == 75 || code == 128 + SIGTERM) ++kills;
    if (code != 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  CHECK(code == 0);
  CHECK(kills >= 3);
  CHECK(summary(folder / "b") == summary(folder / "a"));
  CHECK(count(summary(folder / "a"), ",finished,") == 12);
  CHECK(has(summary(folder / "a"), "s_iterations=4_kernels=paper_step=0.003,s.yaml,"));
  // Once more: nothing is run.
  const auto time =
      fs::last_write_time(folder / "b/s_iterations=1_kernels=paper_step=0.002/run.vtkhdf");
  CHECK(pbf::test::pbf(killed, folder.path()).code == 0);
  CHECK(fs::last_write_time(folder / "b/s_iterations=1_kernels=paper_step=0.002/run.vtkhdf") ==
        time);
}

TEST_CASE("a signal to all processes of a batch, as Slurm and systemd send it, saves its run") {
  const Scratch folder;
  folder.write("s.yaml", tiny_scene());
  Process batch({"batch", "s.yaml", "--grid", "time.end=100000", "--out", "b", "--threads", "1"},
                folder.path());
  const std::string run = (folder / "b/s_end=100000").string();
  wait_until([&] { return fs::exists(run + "/run.vtkhdf"); });
  pid_t child = 0;
  wait_until([&] { return (child = child_of(batch.id())) != 0; });
  REQUIRE(child > 0);
  ::kill(child, SIGTERM);
  batch.send(SIGTERM);
  const Outcome o = batch.wait();
  CAPTURE(o.err);
  CHECK(o.code == 75);
  CHECK(has(o.err, "stopped"));
  CHECK_FALSE(has(o.err, "killed"));
  CHECK(fs::exists(run + "/checkpoint.h5"));
}

TEST_CASE("a batch over a folder tells which runs failed and why, and finishes the others") {
  const Scratch folder;
  fs::create_directory(folder / "scenes");
  folder.write("scenes/good.yaml", tiny_scene());
  folder.write("scenes/bad.yaml", tiny_scene("measure_every: 30\n"));  // warns: strict fails
  folder.write("scenes/cuda.yaml", tiny_scene("backend: cuda\n"));
  folder.write("scenes/notes.txt", "not a scene");
  const Outcome o = pbf::test::pbf({"batch", "scenes", "--strict"}, folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 6);
  CHECK(has(o.out, "3 runs: 1 finished, 2 failed"));
  const std::string table = read_text(folder / "out/batch_scenes/summary.csv");
  CHECK(has(table, "good,scenes/good.yaml,,0,finished,,"));
  CHECK(has(table, "bad,scenes/bad.yaml,,6,warned,"));
  CHECK(has(table, "cuda,scenes/cuda.yaml,,4,unavailable,"));
  CHECK(fs::exists(folder / "out/batch_scenes/good/DONE"));
}

TEST_CASE("every run of a batch is looked at before the first one starts") {
  const Scratch folder;
  fs::create_directory(folder / "scenes");
  folder.write("scenes/a.yaml", tiny_scene());
  folder.write("scenes/bad.yaml", tiny_scene("solver: {iteratons: 3}\n"));
  folder.write("scenes/lost.yaml", tiny_scene());
  const Outcome o = pbf::test::pbf({"batch", "scenes"}, folder.path());
  CHECK(o.code == 2);
  CHECK(has(o.err, "1 of 3 runs cannot start, and none was started:\n  bad: scenes/bad.yaml:"));
  CHECK(has(o.err, "did you mean solver.iterations?"));
  CHECK_FALSE(fs::exists(folder / "out/batch_scenes"));
  // Of a value in the middle of a grid, and of what only the count of particles finds.
  const Outcome grid = pbf::test::pbf(
      {"batch", "scenes/a.yaml", "--grid", "solver.iterations=1:3:5", "--out", "o"}, folder.path());
  CHECK(grid.code == 2);
  CHECK(has(grid.err, "2 of 5 runs cannot start"));
  CHECK(has(grid.err, "a_iterations=1.5: --set solver.iterations=1.5"));
  const Outcome huge = pbf::test::pbf(
      {"batch", "scenes/a.yaml", "--grid", "fluid.spacing=0.1,1e-9", "--out", "o"}, folder.path());
  CHECK(huge.code != 0);
  CHECK(has(huge.err, "1 of 2 runs cannot start"));
  std::string many = "--grid=solver.iterations=0.5";
  for (int k = 1; k < 13; ++k) many += "," + std::to_string(k) + ".5";
  CHECK(has(pbf::test::pbf({"batch", "scenes/a.yaml", many}, folder.path()).err,
            "13 of 13 runs cannot start") == true);
  CHECK(has(pbf::test::pbf({"batch", "scenes/a.yaml", many}, folder.path()).err, "and 3 more"));
  CHECK_FALSE(fs::exists(folder / "o/a_iterations=1"));
}

TEST_CASE("a summary has a column with its unit for every key that the grid or the list sets",
          "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write("list.txt", "tiny.yaml time.end=0.05\ntiny.yaml bodies.0.velocity=[0,0,1] name=x\n");
  const Outcome o = pbf::test::pbf({"batch", "list.txt", "--out", "o", "--grid",
                                    "time.step=0.002:0.003:3", "--set", "measure_every=5"},
                                   folder.path());
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  std::istringstream lines(read_text(folder / "o/summary.csv"));
  std::string units, head, row;
  std::getline(lines, units), std::getline(lines, head);
  CHECK(has(units, "# units: time.end=s, time.step=s, bodies.0.velocity=m/s, time=s, "));
  CHECK(has(units, "kinetic_energy=J"));
  CHECK(has(units, ", seconds=s"));
  CHECK_FALSE(has(units, "compression_mean"));
  CHECK(head.rfind("name,scene,settings,time.end,time.step,bodies.0.velocity,set.name,exit_code,",
                   0) == 0);
  std::vector<std::string> rows;
  while (std::getline(lines, row)) rows.push_back(row);
  REQUIRE(rows.size() == 6);
  CHECK(has(rows[1], ",time.end=0.05 time.step=0.0025,0.05,0.0025,,,0,finished"));
  CHECK(has(rows[5], ",,0.003,\"[0,0,1]\",x,0,finished"));
}

TEST_CASE("a batch of a list takes the settings of its lines, and wrong lists are told by line") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write(
      "list.txt",
      "# two of them\ntiny.yaml time.end=0.05\n\n  tiny.yaml solver.iterations=2 # more\n");
  const Outcome o = pbf::test::pbf(
      {"batch", "list.txt", "--list", "--grid", "bodies[0].velocity=[0,0,1],[0,0,2]"},
      folder.path());
  CHECK(o.code == 0);
  CHECK(has(o.out, "4 runs"));
  CHECK(has(o.out, "  2  tiny_iterations=2_velocity=-0-0-1"));
  CHECK(pbf::test::pbf({"batch", "list.txt", "--quiet"}, folder.path()).code == 0);
  CHECK(fs::exists(folder / "out/batch_list/tiny_end=0.05/DONE"));
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"none.txt"}, "none.txt: cannot be opened"},
      {{"tiny.yaml", "--grid", "solver.iterations"}, "expected KEY=V1,V2"},
      {{"tiny.yaml", "--grid", "solver.iterations=1,,2"}, "empty value"},
      {{"tiny.yaml", "--grid", "fluid.spacing=0.02:0.04"}, "is no range FIRST:LAST:COUNT"},
      {{"tiny.yaml", "--grid", "fluid.spacing=0.02:0.04:x"}, "is no range FIRST:LAST:COUNT"},
      {{"tiny.yaml", "--grid", "fluid.spacing=0.02:0.04:1"}, "is no range FIRST:LAST:COUNT"},
      {{"tiny.yaml", "--time", "30"}, "--time requires --slurm"},
      {{"tiny.yaml", "--only", "1"}, "--only 1"},
      {{"tiny.yaml", "--only", "0", "--share", "yes"}, "--share excludes --only"},
      {{"bad.txt"}, "bad.txt:2: \"iterations\" is not key.path=value"}};
  folder.write("bad.txt", "tiny.yaml\ntiny.yaml iterations 3\n");
  for (auto [args, text] : wrong) {
    args.insert(args.begin(), "batch");
    const Outcome e = pbf::test::pbf(args, folder.path());
    CAPTURE(e.err);
    CHECK(e.code == 2);
    CHECK(has(e.err, text));
  }
}

TEST_CASE(
    "a limit of a batch that passes before a run listens to signals stops it like any other") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  for (const char* limit : {"0.003", "0.006", "0.012", "0.024"}) {
    CAPTURE(limit);
    const Outcome o = pbf::test::pbf(
        {"batch", "tiny.yaml", "--set", "time.end=9000", "--out", "o", "--max-walltime", limit},
        folder.path());
    CHECK(o.code == 75);
    CHECK_FALSE(has(read_text(folder / "o/summary.csv"), "killed by"));
  }
}

TEST_CASE("a run whose file is not its own is not called finished, and is made again", "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const std::vector<std::string> batch{"batch", "tiny.yaml", "--out", "o", "--threads", "1"};
  auto collect = batch;
  collect.emplace_back("--collect");
  REQUIRE(pbf::test::pbf(batch, folder.path()).code == 0);
  const std::string good = read_text(folder / "o/tiny/run.vtkhdf");
  REQUIRE(pbf::test::pbf({"run", "tiny.yaml", "--quiet", "--out", "y", "--set", "time.end=0.05"},
                         folder.path())
              .code == 0);
  std::string why;
  SECTION("garbage") {
    folder.write("o/tiny/run.vtkhdf", "garbage");
    why = "DONE is there, but o/tiny/run.vtkhdf: cannot read";
  }
  SECTION("empty") {
    folder.write("o/tiny/run.vtkhdf", "");
    why = "DONE is there, but o/tiny/run.vtkhdf: cannot read";
  }
  SECTION("truncated") {
    folder.write("o/tiny/run.vtkhdf", good.substr(0, good.size() / 2));
    why = "DONE is there, but o/tiny/run.vtkhdf: cannot read";
  }
  SECTION("missing") {
    fs::remove(folder / "o/tiny/run.vtkhdf");
    why = "DONE is there, but run.vtkhdf is missing";
  }
  SECTION("of a shorter run") {
    fs::copy_file(folder / "y/run.vtkhdf", folder / "o/tiny/run.vtkhdf",
                  fs::copy_options::overwrite_existing);
    why = "DONE is there, but the frames of run.vtkhdf end at update 10, the run at 20";
  }
  const Outcome seen = pbf::test::pbf(collect, folder.path());
  CAPTURE(seen.out, seen.err);
  CHECK(seen.code == 75);
  CHECK(has(seen.out, "1 runs: 0 finished, 0 failed, 1 to go on with"));
  CHECK(has(seen.err, why));
  CHECK(has(read_text(folder / "o/summary.csv"), "but "));
  const Outcome again = pbf::test::pbf(batch, folder.path());
  CAPTURE(again.err);
  CHECK(again.code == 0);
  CHECK(has(again.out, "1 finished"));
  CHECK(has(read_text(folder / "o/tiny/log.txt"), why));
  CHECK(pbf::test::pbf({"compare", "o/tiny/run.vtkhdf", "o/tiny/run.vtkhdf"}, folder.path()).code ==
        0);
  CHECK(pbf::test::pbf(collect, folder.path()).code == 0);
}

TEST_CASE("a run file of another scene in a finished run's folder is a failed run, and is kept") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const std::vector<std::string> batch{"batch", "tiny.yaml", "--out", "o", "--threads", "1"};
  auto collect = batch;
  collect.emplace_back("--collect");
  REQUIRE(pbf::test::pbf(batch, folder.path()).code == 0);
  REQUIRE(pbf::test::pbf({"run", "tiny.yaml", "--quiet", "--out", "x", "--set", "gravity=[0,0,-5]"},
                         folder.path())
              .code == 0);
  fs::copy_file(folder / "x/run.vtkhdf", folder / "o/tiny/run.vtkhdf",
                fs::copy_options::overwrite_existing);
  for (const auto& command : {collect, batch}) {
    const Outcome o = pbf::test::pbf(command, folder.path());
    CAPTURE(o.out, o.err);
    CHECK(o.code == 6);
    CHECK(has(o.out, "0 finished, 1 failed"));
    CHECK(has(o.err, "of another scene: gravity"));
  }
  CHECK(read_text(folder / "o/tiny/run.vtkhdf") == read_text(folder / "x/run.vtkhdf"));
}

TEST_CASE("a batch whose scenes have changed is not collected as finished") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  REQUIRE(pbf::test::pbf({"batch", "tiny.yaml", "--out", "o"}, folder.path()).code == 0);
  const auto collect = [&](const char* key) {
    return pbf::test::pbf({"batch", "tiny.yaml", "--out", "o", "--collect", "--set", key},
                          folder.path());
  };
  CHECK(collect("threads=2").code == 0);  // no other run
  const Outcome other = collect("gravity=[0,0,-5]");
  CHECK(other.code == 6);
  CHECK(has(other.err, "is of another scene: gravity"));
  const Outcome longer = collect("time.end=0.2");
  CHECK(longer.code == 75);
}
