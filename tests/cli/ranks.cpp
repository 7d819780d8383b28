// `mpirun -n P pbf run`: processes as ranks.
#include <filesystem>

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
