// pbf batch --share: runs that share a process get what each gets by itself, whatever happens to
// that process.
#include <csignal>
#include <set>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/run_file_samples.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// A dam break of some hundred particles; its runs take tenths of a second.
const char* const kShared =
    "name: s\n"
    "domain: {min: [0, 0, 0], max: [1, 0.6, 1]}\n"
    "fluid: {spacing: 0.08}\n"
    "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.6, 0.6]}]\n"
    "time: {step: 0.002, end: 0.6}\n"
    "output: {every: 0.05}\n";

Args batch_of(const char* out, const char* share) {
  return {"batch",     "s.yaml",
          "--grid",    "solver.iterations=1,2,3",
          "--grid",    "viscosity.xsph=0,0.05",
          "--out",     out,
          "--jobs",    "3",
          "--threads", "1",
          "--share",   share};
}

/// Every run of `b` is that of `a`, to the last bit.
void check_same_runs(const Scratch& folder, const std::string& a, const std::string& b) {
  std::size_t runs = 0;
  for (const auto& entry : fs::directory_iterator(folder / a)) {
    if (!entry.is_directory()) continue;
    const std::string name = entry.path().filename().string();
    CAPTURE(name);
    ++runs;
    CHECK(fs::exists(folder / b / name / "DONE"));
    const pbf::RunReader left((folder / a / name / "run.vtkhdf").string()),
        right((folder / b / name / "run.vtkhdf").string());
    REQUIRE(left.frames() == 13);
    REQUIRE(right.frames() == 13);
    for (std::int64_t k = 0; k < 13; ++k) CHECK(same(left.frame(k), right.frame(k)));
    for (const std::string& column : left.log_columns())
      if (!column.starts_with("stage/")) CHECK(left.log_column(column) == right.log_column(column));
  }
  CHECK(runs == 6);
}

}  // namespace

TEST_CASE("runs that share a process are those that have one each", "[slow]") {
  const Scratch folder;
  folder.write("s.yaml", kShared);
  const Outcome apart = pbf::test::pbf(batch_of("a", "no"), folder.path());
  const Outcome shared = pbf::test::pbf(batch_of("b", "yes"), folder.path());
  CAPTURE(apart.err, shared.err);
  REQUIRE(apart.code == 0);
  REQUIRE(shared.code == 0);
  CHECK(has(shared.out, "6 runs: 6 finished, 0 failed"));
  check_same_runs(folder, "a", "b");
}

TEST_CASE("when the process that runs share dies, none of them is lost", "[slow]") {
  const Scratch folder;
  folder.write("s.yaml", kShared);
  REQUIRE(pbf::test::pbf(batch_of("a", "no"), folder.path()).code == 0);
  const int signal = GENERATE(SIGKILL, SIGSEGV);
  Process batch(batch_of("b", "yes"), folder.path());
  std::set<pid_t> killed;
  wait_until([&] {  // each one that it starts, three times
    const pid_t server = child_of(batch.id(), "serve-batch");
    const bool busy =
        fs::exists(folder / "b") &&
        std::distance(fs::directory_iterator(folder / "b"), fs::directory_iterator()) > 0;
    if (server > 0 && busy && killed.insert(server).second) ::kill(server, signal);
    return killed.size() == 3 || !batch.running();
  });
  const Outcome o = batch.wait();
  CAPTURE(o.err);
  CHECK(killed.size() >= 1);
  CHECK(o.code == 0);
  CHECK(has(o.out, "6 runs: 6 finished, 0 failed, 0 to go on with"));
  check_same_runs(folder, "a", "b");
}

TEST_CASE("a signal to a batch whose runs share a process saves them all, and they go on",
          "[slow]") {
  const Scratch folder;
  folder.write("s.yaml", kShared);
  REQUIRE(pbf::test::pbf(batch_of("a", "no"), folder.path()).code == 0);
  const int signal = GENERATE(SIGTERM, SIGKILL);  // of a killed batch, the runs get SIGTERM
  Process batch(batch_of("b", "yes"), folder.path());
  wait_until([&] {
    return fs::exists(folder / "b/s_iterations=1_xsph=0/run.vtkhdf") || !batch.running();
  });
  const pid_t server = child_of(batch.id(), "serve-batch");
  batch.send(signal);
  const Outcome o = batch.wait();
  CAPTURE(o.err);
  CHECK(o.code == (signal == SIGTERM ? 75 : 128 + SIGKILL));
  wait_until([&] { return server == 0 || ::kill(server, 0) != 0; });
  const Outcome again = pbf::test::pbf(batch_of("b", "yes"), folder.path());
  CAPTURE(again.err);
  CHECK(again.code == 0);
  check_same_runs(folder, "a", "b");
}

TEST_CASE("a run that fails beside others in a process costs none of them") {
  const Scratch folder;
  folder.write("s.yaml", kShared);
  folder.write("list.txt",
               "s.yaml name=good\n"
               "s.yaml name=no_gpu backend=cuda time.end=0.01\n"
               "s.yaml name=fast guard.speed=0.001\n"
               "s.yaml name=also_good\n");
  const Outcome o = pbf::test::pbf(
      {"batch", "list.txt", "--out", "o", "--share", "yes", "--threads", "1", "--jobs", "4"},
      folder.path());
  CAPTURE(o.out, o.err);
  CHECK(o.code == 6);
  const std::string table = read_text(folder / "o/summary.csv");
  CAPTURE(table);
  CHECK(has(table, "s_name=good,s.yaml,name=good,good,,,,0,finished,"));
  CHECK(has(table, ",fast,,,0.001,3,diverged,"));
  CHECK(has(table, ",no_gpu,cuda,0.01,,4,unavailable,"));
  CHECK(has(table, "also_good,,,,0,finished,"));
  CHECK(has(o.err, "speed"));
}
