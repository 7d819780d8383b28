// SIGKILL at random moments: no frame that was reported is lost, every file opens, and the run that
// is resumed ends in the bytes of the undisturbed one. tests/regression/kill_runs does more of it.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <sstream>
#include <thread>

#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/mpirun.h"
#include "tests/support/same_run.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// 600 updates with a frame after every second one; checkpoints often enough to be hit as well.
std::string write_frequent(const Scratch& folder) {
  return folder.write("s.yaml",
                      "name: s\n"
                      "domain: {min: [0, 0, 0], max: [1, 0.6, 1]}\n"
                      "fluid: {spacing: 0.05}\n"
                      "bodies:\n"
                      "  - {shape: block, min: [0, 0, 0], max: [0.4, 0.6, 0.6]}\n"
                      "time: {step: 0.002, end: 4.8}\n"
                      "viscosity: {}\n"
                      "measure_every: 4\n"
                      "checkpoint: {every: 0.05}\n"
                      "output: {every: 0.004}\n");
}

int number(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}

/// The largest number of frames that the lines of --log-json called safe.
std::int64_t reported(const fs::path& json) {
  std::istringstream lines(read_text(json));
  std::int64_t most = 0;
  const std::string key = "\"frames\":";
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t at = line.find(key); at != std::string::npos && line.back() == '}')
      most = std::max(most, std::int64_t(std::atoll(line.c_str() + at + key.size())));
  return most;
}

/// Opens the file with h5py, where PBF_H5PY names a Python that has it; true when there is none.
bool opens_in_h5py(const fs::path& file, std::int64_t frames) {
  const char* python = std::getenv("PBF_H5PY");
  if (!python) return true;
  const std::string command = std::string(python) + " -c 'import h5py, sys; f = h5py.File(\"" +
                              file.string() + "\", \"r\"); s = f[\"VTKHDF/Steps\"]; " +
                              "n = int(s.attrs[\"NSteps\"]); k = s[\"PointOffsets\"][n - 1]; " +
                              "x = f[\"VTKHDF/Points\"][k:k + 10]; " + "sys.exit(n < " +
                              std::to_string(frames) + " or len(x) != 10)'";
  return std::system(command.c_str()) == 0;
}

/// Whether mpirun ends within half a minute. Open MPI 4.1 can wait for ever for a rank that is
/// killed while it connects, although all have ended: then mpirun is killed. A rank that is left is
/// a hang.
bool ends(const Process& mpirun, const Scratch& folder) {
  if (comes_true([&] { return !mpirun.running(); }, 30)) return true;
  for (int rank = 0; rank < 4; ++rank) {
    CAPTURE(rank);
    CHECK(process_of_rank(rank, folder) == -1);
  }
  mpirun.send(SIGKILL);
  return false;
}

/// most_ranks: a random rank of 2 to so many is killed, and others go on; 1: without ranks.
void kill_and_resume(int kills, int most_ranks) {
  const unsigned seed = static_cast<unsigned>(number("PBF_SEED", 1));
  std::mt19937 random(seed);
  const Scratch folder;
  write_frequent(folder);
  const std::string gzip = number("PBF_GZIP", 0) ? "gzip" : "none";
  const std::vector<std::string> args{
      "run",       "s.yaml", "--resume", "--quiet",
      "--threads", "1",      "--set",    "output.compression=" + gzip};
  auto undisturbed = args, killed = args;
  undisturbed.insert(undisturbed.end(), {"--out", "a"});
  killed.insert(killed.end(), {"--out", "b", "--log-json", "b.json"});
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(pbf::test::pbf(undisturbed, folder.path()).code == 0);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  int done = 0, rounds = 0, hit = 0, stuck = 0;
  // Few kills may all come before the first reported frame.
  while (done < kills || (hit == 0 && done < 10 * kills)) {
    // A run that was killed often enough is finished, compared, and a new one is begun.
    const int ranks = std::uniform_int_distribution<>(std::min(2, most_ranks), most_ranks)(random);
    const int victim = std::uniform_int_distribution<>(0, ranks - 1)(random);
    Process p = ranks > 1 ? start_ranks(ranks, killed, folder) : Process(killed, folder.path());
    if (ranks > 1) wait_until([&] { return process_of_rank(victim, folder) > 0; });
    const double wait = std::uniform_real_distribution<>(0.01, 0.6 * seconds)(random);
    std::this_thread::sleep_for(std::chrono::duration<double>(wait));
    if (ranks == 1)
      p.send(SIGKILL);
    else if (const pid_t one = process_of_rank(victim, folder); one > 0)
      kill(one, SIGKILL);
    if (ranks > 1 && !ends(p, folder)) ++stuck;
    const auto [code, out, err] = p.wait();
    CAPTURE(seed, done, wait, err, ranks, victim);
    REQUIRE((code == 128 + SIGKILL || code == 0));
    if (code != 0) ++done;
    const std::int64_t safe = reported(folder / "b.json");
    if (safe > 0) {
      const pbf::RunReader reader((folder / "b/run.vtkhdf").string());
      REQUIRE(reader.frames() >= safe);
      REQUIRE(reader.frame(reader.frames() - 1).count == reader.frame(0).count);
      REQUIRE(opens_in_h5py(folder / "b/run.vtkhdf", safe));
      ++hit;
    }
    if (code == 0 || done >= kills) {
      REQUIRE(pbf::test::pbf(killed, folder.path()).code == 0);
      REQUIRE(run_difference(folder / "a/run.vtkhdf", folder / "b/run.vtkhdf") == "");
      fs::remove_all(folder / "b");
      fs::remove(folder / "b.json");
      ++rounds;
    }
  }
  WARN(done << " kills, " << hit << " files with reported frames looked at, " << rounds
            << " resumed runs ended in the bytes of the undisturbed run; mpirun had to be killed "
            << stuck << " times");
  CHECK(hit > 0);
}

}  // namespace

TEST_CASE("runs killed at random moments lose no reported frame and end in the same bytes",
          "[slow]") {
  kill_and_resume(number("PBF_KILLS", 6), 1);
}

TEST_CASE(
    "runs of which a random rank is killed lose no reported frame, and another number of "
    "ranks goes on to the same bytes",
    "[slow]") {
  if (!has_mpi()) PBF_SKIP("no mpirun, or no module for MPI");
  kill_and_resume(number("PBF_KILLS", 3), 4);
}
