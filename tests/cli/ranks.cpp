// `mpirun -n P pbf run`: processes as ranks.
#include <filesystem>
#include <sstream>

#include "lib/io/run_file.h"
#include "tests/support/mpirun.h"
#include "tests/support/same_run.h"

namespace fs = std::filesystem;
using namespace pbf::test;

namespace {

std::string sloshing(const Scratch& folder) {
  return folder.write("s.yaml", R"(
domain: {min: [0, 0, 0], max: [0.8, 0.2, 0.4], loads: true}
fluid: {spacing: 0.02}
bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.2, 0.3]}]
obstacles: [{name: box, shape: box, min: [0.5, 0.05, 0], max: [0.6, 0.15, 0.1], loads: true}]
viscosity: {xsph: 0.05}
time: {step: 0.002, end: 0.3}
output: {every: 0.1, fields: [velocity, density]}
measure_every: 10
guard: {}
checkpoint: {}
threads: 1
)");
}

/// What a run says of its start and of what it found, without times and machines.
std::string notes(const fs::path& log) {
  std::istringstream lines(read_text(log));
  std::string all;
  for (std::string line; std::getline(lines, line);)
    if (has(line, "start:") || has(line, "warning")) all += line + "\n";
  return all;
}

/// Runs pbf on several ranks, of which number `one` starts through lines of bash.
Outcome with_one(int ranks, int one, const std::string& bash, const Args& args,
                 const Scratch& folder) {
  Args words{"-n", std::to_string(one), PBF_BINARY};
  const auto add = [&](const Args& more) { words.insert(words.end(), more.begin(), more.end()); };
  add(args);
  add({":", "-n", "1", "bash", "-c", bash + "; exec \"$0\" \"$@\"", PBF_BINARY});
  add(args);
  if (const int after = ranks - one - 1) {
    add({":", "-n", std::to_string(after), PBF_BINARY});
    add(args);
  }
  return start_mpirun(words, folder).wait();
}
Outcome ranks_of_which_one_may_write(int ranks, int one, int kilobytes, const Args& args,
                                     const Scratch& folder) {
  return with_one(ranks, one, "ulimit -f " + std::to_string(kilobytes), args, folder);
}
Outcome ranks_of_which_one_is_blind(int ranks, int one, const Args& args, const Scratch& folder) {
  fs::create_directory(folder / "out");
  if (std::system("unshare -m true 2> /dev/null") != 0) return {77, "", ""};
  return with_one(ranks, one,
                  "exec unshare -m bash -c 'mount -t tmpfs none out && exec \"$0\" \"$@\"' \"$0\" "
                  "\"$@\"",
                  args, folder);
}

}  // namespace

TEST_CASE("several ranks write the run file of one", "[slow]") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  const Scratch folder;
  const std::string scene = sloshing(folder);
  const Outcome one = pbf::test::pbf({"run", scene, "--out", "one", "--quiet"}, folder.path());
  CHECK(one.err == "");
  REQUIRE(one.code == 0);
  for (const int ranks : {2, 4}) {
    const std::string out = "ranks" + std::to_string(ranks);
    const Outcome all = on_ranks(ranks, {"run", scene, "--out", out, "--quiet"}, folder);
    CHECK(all.err == "");
    REQUIRE(all.code == 0);
    CHECK(run_difference(folder / "one/run.vtkhdf", folder / (out + "/run.vtkhdf")) == "");
  }
}

TEST_CASE(
    "several ranks write the run file of one: compressed, in double, from a start that settles or "
    "is relieved, with open faces and steps that adapt",
    "[slow]") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  const Scratch folder;
  const std::string scene = sloshing(folder);
  folder.write("some.csv", "x,y,z,vx,vy,vz\n0.7,0.1,0.35,0,0,-1\n0.72,0.1,0.35,0,0,-1\n");
  const std::string drops =
      "bodies=[{shape: file, path: some.csv}, {shape: random_box, min: [0, 0, 0], max: [0.4, 0.2, "
      "0.2], count: 3000, seed: 2, velocity: [0.5, 0, 0]}]";
  for (const Args& set : std::vector<Args>{
           {"output.compression=gzip", "output.precision=double"},
           {"precision=double", "output.precision=double"},
           {"settle={duration: 0.1}"},
           {drops, "domain.open=[x_max]", "domain.loads=false", "obstacles=[]", "time.end=0.6"},
           {"time.adaptive={}", "time.step=0.01"}}) {
    Args words{"run", scene, "--quiet"};
    for (const std::string& s : set) words.insert(words.end(), {"--set", s});
    CAPTURE(set);
    const auto into = [&](const std::string& out) {
      fs::remove_all(folder / out);
      Args all = words;
      all.insert(all.end(), {"--out", out});
      return all;
    };
    const Outcome one = pbf::test::pbf(into("one"), folder.path());
    CAPTURE(one.err);
    REQUIRE(one.code == 0);
    for (const int ranks : {2, 4}) {
      const Outcome all = on_ranks(ranks, into("ranks"), folder);
      CAPTURE(ranks, all.err);
      REQUIRE(all.code == 0);
      CHECK(run_difference(folder / "one/run.vtkhdf", folder / "ranks/run.vtkhdf") == "");
      CHECK(notes(folder / "one/log.txt") == notes(folder / "ranks/log.txt"));
    }
  }
}

TEST_CASE("a rank whose disk is full ends all with one error, and earlier frames are kept",
          "[slow]") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  const Scratch folder;
  const std::string scene = sloshing(folder);
  // The limit of one rank alone: its file system refuses what that of rank 0 has room for.
  const Outcome o = ranks_of_which_one_may_write(
      3, 1, 6000, {"run", scene, "--out", "out", "--quiet", "--set", "output.every=0.002"}, folder);
  CAPTURE(o.out, o.err);
  CHECK(o.code == 5);
  CHECK(count(o.err, "pbf: error: rank 1 on ") == 1);
  CHECK(count(o.err,
              "cannot write this rank's part of a frame: File too large; the frames before "
              "it are kept") == 1);
  const pbf::RunReader reader((folder / "out/run.vtkhdf").string());
  CHECK(reader.frames() > 10);
  const Outcome rest = on_ranks(
      2, {"run", scene, "--out", "out", "--resume", "--quiet", "--set", "output.every=0.002"},
      folder);
  CAPTURE(rest.err);
  REQUIRE(rest.code == 0);
  REQUIRE(pbf::test::pbf({"run", scene, "--out", "one", "--quiet", "--set", "output.every=0.002"},
                         folder.path())
              .code == 0);
  CHECK(run_difference(folder / "one/run.vtkhdf", folder / "out/run.vtkhdf") == "");
}

TEST_CASE("no rank takes memory in proportion to all particles: the peaks of four and of one",
          "[slow]") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  const Scratch folder;
  folder.write("s.yaml", R"(
domain: {min: [0, 0, 0], max: [2, 1, 1]}
fluid: {spacing: 0.0118}
bodies: [{shape: block, min: [0, 0, 0], max: [1, 1, 1]}]
time: {step: 0.0005, end: 0.001}
solver: {iterations: 1}
output: {every: 0.0005}
guard: {}
checkpoint: {}
threads: 1
)");
  const auto peak = [](pid_t process) {  // kB, so far
    const std::string status = read_text("/proc/" + std::to_string(process) + "/status");
    const std::size_t at = status.find("VmHWM:");
    return at == std::string::npos ? 0L : std::stol(status.substr(at + 6));
  };
  long alone = 0;
  for (Process one({"run", "s.yaml", "--out", "one", "--quiet"}, folder.path());;) {
    alone = std::max(alone, peak(one.id()));
    if (one.running()) continue;
    REQUIRE(one.wait().code == 0);
    break;
  }
  long of_rank[4] = {};
  for (Process all = start_ranks(4, {"run", "s.yaml", "--out", "four", "--quiet"}, folder);;) {
    for (int r = 0; r < 4; ++r) of_rank[r] = std::max(of_rank[r], peak(process_of_rank(r, folder)));
    if (all.running()) continue;
    REQUIRE(all.wait().code == 0);
    break;
  }
  // A tenth is the program and its libraries.
  REQUIRE(alone > 150000);
  for (const long kilobytes : of_rank) {
    CAPTURE(alone, of_rank[0], of_rank[1], of_rank[2], of_rank[3]);
    CHECK(kilobytes > 0);
    CHECK(double(kilobytes) < 0.65 * double(alone));
  }
}

TEST_CASE("a rank that does not see the run file leaves its rows to rank 0, and the log says so",
          "[slow]") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  const Scratch folder;
  const std::string scene = sloshing(folder);
  REQUIRE(pbf::test::pbf({"run", scene, "--out", "one", "--quiet"}, folder.path()).code == 0);
  const Outcome o =
      ranks_of_which_one_is_blind(3, 2, {"run", scene, "--out", "out", "--resume"}, folder);
  if (o.code == 77) PBF_SKIP("this user may not make a mount of its own");
  CAPTURE(o.out, o.err);
  REQUIRE(o.code == 0);
  CHECK(count(o.out + o.err, "not all ranks see out/run.vtkhdf, so rank 0 writes for all") == 1);
  CHECK(run_difference(folder / "one/run.vtkhdf", folder / "out/run.vtkhdf") == "");
}

TEST_CASE(
    "ranks that are asked to stop save and end with 75, and another number of them goes on to the "
    "same bytes",
    "[slow]") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  const Scratch folder;
  const std::string scene = sloshing(folder);
  REQUIRE(pbf::test::pbf({"run", scene, "--out", "one", "--quiet"}, folder.path()).code == 0);
  Process ranks = start_ranks(2, {"run", scene, "--out", "out"}, folder);
  wait_until([&] { return fs::exists(folder / "out/run.vtkhdf"); });
  ranks.send(SIGUSR2);
  const Outcome stopped = ranks.wait();
  CAPTURE(stopped.out, stopped.err);
  CHECK(stopped.code == 75);
  CHECK(has(stopped.out + stopped.err, "stopped early by SIGUSR2"));
  const Outcome rest = on_ranks(3, {"run", scene, "--out", "out", "--resume", "--quiet"}, folder);
  CAPTURE(rest.err);
  REQUIRE(rest.code == 0);
  CHECK(run_difference(folder / "one/run.vtkhdf", folder / "out/run.vtkhdf") == "");
}

TEST_CASE("on several ranks an error is told once, and ends them with its code") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  const Scratch folder;
  const std::string scene = sloshing(folder);
  const Outcome wrong = on_ranks(2, {"run", "none.yaml"}, folder);
  CHECK(wrong.code == 2);
  CHECK(count(wrong.err, "none.yaml") == 1);
  const Outcome many = on_ranks(30, {"run", scene, "--out", "many"}, folder);
  CHECK(many.code == 2);
  CHECK(count(many.err, "start at most 21 ranks") == 1);
  const Outcome plan = on_ranks(2, {"plan", scene}, folder);
  CHECK(plan.code == 2);
  CHECK(count(plan.err, "only run, bench and batch --only work on several ranks") == 1);
}

TEST_CASE("a rank that hangs is named, and ends the others with 4") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  const Scratch folder;
  const std::string scene = sloshing(folder);
  for (const int hangs : {0, 2}) {
    const std::string out = "out" + std::to_string(hangs);
    Process ranks = start_ranks(3, {"run", scene, "--out", out, "--set", "time.end=100"}, folder,
                                {"PBF_RANK_DEADLINE=0.5"});
    wait_until([&] { return fs::exists(folder / (out + "/run.vtkhdf")); });
    kill(process_of_rank(hangs, folder), SIGSTOP);
    const Outcome o = ranks.wait();
    CAPTURE(o.out, o.err);
    CHECK(o.code == 4);
    CHECK(count(o.err, "rank " + std::to_string(hangs) + " on ") == 1);
    CHECK(has(o.err, "it hangs, or its machine is gone"));
  }
  const Outcome o = start_ranks(2, {"run", scene}, folder, {"PBF_RANK_DEADLINE=soon"}).wait();
  CHECK(o.code == 2);
  CHECK(count(o.err, "PBF_RANK_DEADLINE is \"soon\"") == 1);
}

TEST_CASE("several ranks without the module for MPI: the error has the command that makes it") {
  const Scratch folder;
  const Outcome o = pbf::test::pbf({"run", "s.yaml"}, folder.path(),
                                   {"OMPI_COMM_WORLD_SIZE=2", "PBF_MPI=/nowhere.so"});
  CHECK(o.code == 4);
  CHECK(has(o.err, "mpicc -O2 -shared -fPIC -o libpbf_mpi.so"));
}
