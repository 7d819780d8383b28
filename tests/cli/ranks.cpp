// `mpirun -n P pbf run`: processes as ranks.
#include <csignal>
#include <filesystem>

#include "tests/support/process.h"
#include "tests/support/same_run.h"

namespace fs = std::filesystem;
using namespace pbf::test;

namespace {

bool has_mpi() {
  return fs::exists(fs::path(PBF_BINARY).parent_path() / "libpbf_mpi.so") &&
         std::system("mpirun --version > /dev/null 2>&1") == 0;
}
/// mpirun of Open MPI; root in a container, more ranks than cores, and none waits on a core.
const Args kAsRoot = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                      "OMPI_MCA_mpi_yield_when_idle=1", "OMPI_MCA_rmaps_base_oversubscribe=1",
                      "OMPI_MCA_btl_vader_single_copy_mechanism=none"};
Process start_ranks(int ranks, const Args& args, const Scratch& folder) {
  Args words = {"/usr/bin/env", "mpirun", "-n", std::to_string(ranks), PBF_BINARY};
  words.insert(words.end(), args.begin(), args.end());
  return Process::program(words, folder.path(), kAsRoot);
}
Outcome on_ranks(int ranks, const Args& args, const Scratch& folder) {
  return start_ranks(ranks, args, folder).wait();
}
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
  CHECK(count(plan.err, "only run works on several ranks") == 1);
}

TEST_CASE("several ranks without the module for MPI: the error has the command that makes it") {
  const Scratch folder;
  const Outcome o = pbf::test::pbf({"run", "s.yaml"}, folder.path(),
                                   {"OMPI_COMM_WORLD_SIZE=2", "PBF_MPI=/nowhere.so"});
  CHECK(o.code == 4);
  CHECK(has(o.err, "mpicc -O2 -shared -fPIC -o libpbf_mpi.so"));
}
