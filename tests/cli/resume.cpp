// pbf run --resume: a run that was stopped or killed becomes the run that nobody disturbed.
#include <hdf5.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "lib/io/h5.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// 400 updates with everything that keeps a memory: log, energies, frames at odd times.
std::string write_scene(const Scratch& folder) {
  return folder.write("s.yaml",
                      "name: s\n"
                      "domain: {min: [0, 0, 0], max: [1, 0.6, 1], loads: true}\n"
                      "fluid: {spacing: 0.05}\n"
                      "bodies:\n"
                      "  - {shape: block, min: [0, 0, 0], max: [0.4, 0.6, 0.6]}\n"
                      "time: {step: 0.002, end: 0.8}\n"
                      "viscosity: {xsph: 0.05}\n"
                      "tensile: {}\n"
                      "measure_every: 7\n"
                      "output: {every: 0.01}\n");
}

std::string difference(const Scratch& folder, const std::string& a, const std::string& b) {
  return run_difference(folder / (a + "/run.vtkhdf"), folder / (b + "/run.vtkhdf"));
}

/// Where the middle of a data set of one chunk is in its file, bytes.
std::size_t middle_of(const fs::path& file, const char* name) {
  const pbf::h5::Lock lock;
  const pbf::h5::File opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, pbf::h5::file_access()));
  const pbf::h5::Dataset data = pbf::h5::open_dataset(opened, name);
  haddr_t begin = 0;
  hsize_t bytes = 0;
  const hsize_t first[2] = {0, 0};
  pbf::h5::check(H5Dget_chunk_info_by_coord(data, first, nullptr, &begin, &bytes));
  return std::size_t(begin + bytes / 2);
}

/// Starts a run and sends it a signal when it has at least so many frames, and `file` (if any) is
/// there.
Outcome end_by(const Scratch& folder, const Args& args, int signal, std::int64_t frames,
               const std::string& file = {}) {
  Process p(args, folder.path());
  for (int i = 0; i < 2000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    try {
      if (pbf::RunReader((folder / "b/run.vtkhdf").string()).frames() >= frames &&
          (file.empty() || fs::exists(folder / file)))
        break;
    } catch (const std::exception&) {  // not there yet
    }
  }
  p.send(signal);
  return p.wait();
}

}  // namespace

TEST_CASE("a run stopped again and again ends in the bytes of the undisturbed run", "[slow]") {
  const Scratch folder;
  write_scene(folder);
  const std::string precision = GENERATE("float", "double");
  REQUIRE(run_scene(folder, "a", {"--precision", precision}).code == 0);
  int stops = 0, code = 75;
  double limit = 0.1;  // s, grows: a slow machine takes that long to start
  for (; code == 75 && stops < 100; limit *= 1.1) {
    // Wherever the wall-time limit falls; threads do not change bits.
    const Outcome o = pbf::test::pbf(
        {"run", "s.yaml", "--out", "b", "--quiet", "--resume", "--precision", precision,
         "--max-walltime", std::to_string(limit), "--threads", stops % 2 ? "2" : "1"},
        folder.path());
    CAPTURE(o.err);
    code = o.code;
    REQUIRE((code == 75 || code == 0));
    stops += code == 75;
  }
  REQUIRE(code == 0);
  CAPTURE(stops);
  CHECK(stops >= 1);
  CHECK(difference(folder, "a", "b") == "");
  // The start is relieved once, and told once.
  const std::string log = read_text(folder / "b/log.txt");
  CHECK(has(log, "start: compression mean"));
  CHECK(log.find("start: compression mean") == log.rfind("start: compression mean"));
  const auto sessions = pbf::RunReader((folder / "b/run.vtkhdf").string()).sessions();
  REQUIRE(sessions.size() == std::size_t(stops) + 1);
  for (std::size_t k = 0; k + 1 < sessions.size(); ++k) {
    CHECK(sessions[k].reason == "--max-walltime");
    CHECK(sessions[k].last_update == sessions[k + 1].first_update);
  }
  CHECK(sessions.back().reason == "finished");
  CHECK(sessions.back().last_update == 400);
}

TEST_CASE("a killed run keeps its frames and ends in the same bytes, with and without checkpoint",
          "[slow]") {
  const Scratch folder;
  write_scene(folder);
  const bool checkpoint = GENERATE(false, true);
  const std::string set = checkpoint ? "checkpoint.every=0.02" : "checkpoint=off";
  REQUIRE(run_scene(folder, "a", {"--set", set}).code == 0);
  const Args args{"run",     "s.yaml",    "--out", "b",     "--resume",
                  "--quiet", "--threads", "1",     "--set", set};
  std::int64_t before = 0;
  for (const std::int64_t frames : {3, 9, 20}) {
    // How soon the first checkpoint comes depends on how busy the machine is.
    const std::string file = checkpoint && frames == 20 ? "b/checkpoint.h5" : "";
    CHECK(end_by(folder, args, SIGKILL, frames, file).code == 128 + SIGKILL);
    const pbf::RunReader reader((folder / "b/run.vtkhdf").string());
    CHECK(reader.frames() >= std::max(frames, before));
    before = reader.frames();
    CHECK(reader.status() == "running");
    CHECK(reader.sessions().back().ended.empty());
  }
  CHECK(fs::exists(folder / "b/checkpoint.h5") == checkpoint);
  REQUIRE(run_scene(folder, "b", {"--resume", "--set", set}).code == 0);
  CHECK(difference(folder, "a", "b") == "");
}

TEST_CASE("a finished run can be prolonged, to the bytes of the long run", "[slow]") {
  const Scratch folder;
  write_scene(folder);
  const std::string end = GENERATE("0.113", "0.12");  // not at, and at, a frame
  for (const char* set : {"checkpoint={}", "checkpoint=off"}) {
    CAPTURE(set, end);
    fs::remove_all(folder / "a");
    fs::remove_all(folder / "b");
    REQUIRE(run_scene(folder, "a", {"--set", "time.end=0.2", "--set", set}).code == 0);
    REQUIRE(run_scene(folder, "b", {"--set", "time.end=" + end, "--set", set}).code == 0);
    const Outcome o = run_scene(folder, "b", {"--set", "time.end=0.2", "--set", set, "--resume"});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
    CHECK(difference(folder, "a", "b") == "");
    CHECK(run_scene(folder, "b", {"--set", "time.end=0.1", "--resume"}).code == 0);  // it is done
  }
}

TEST_CASE("an earlier end is told where it lies ahead, and leaves a run alone that is beyond it",
          "[slow]") {
  const Scratch folder;
  write_scene(folder);
  const auto with = [&](const std::string& out, const std::string& end) {
    return pbf::test::pbf(
        {"run", "s.yaml", "--out", out, "--threads", "1", "--resume", "--set", "time.end=" + end},
        folder.path());
  };
  // Finished up to 0.2 s.
  REQUIRE(run_scene(folder, "b", {"--set", "time.end=0.2"}).code == 0);
  const Outcome done = with("b", "0.1");
  CHECK(done.code == 0);
  CHECK(has(done.err,
            "b: the run is finished, up to 0.2 s, beyond time.end, which is now 0.1 s; nothing to "
            "do"));
  CHECK(has(with("b", "0.2").err, "b: the run is finished (DONE is there); nothing to do"));

  // Stopped on the way to 0.8 s.
  REQUIRE(run_scene(folder, "c", {"--set", "time.end=80", "--max-walltime", "0.5"}).code == 75);
  const std::string file = read_text(folder / "c/run.vtkhdf");
  const Outcome beyond = with("c", "0.002");
  CAPTURE(beyond.err);
  CHECK(beyond.code == 0);
  CHECK(has(beyond.err, "c: the run was stopped at "));
  CHECK(has(beyond.err,
            ", beyond time.end, which is now 0.002 s; nothing to do. A later time.end "
            "goes on from there"));
  CHECK(read_text(folder / "c/run.vtkhdf") == file);
  CHECK_FALSE(fs::exists(folder / "c/DONE"));
  // Nothing is said to be there that is not: the run file is looked at.
  fs::rename(folder / "c/run.vtkhdf", folder / "c/kept");
  const Outcome lost = with("c", "0.002");
  CHECK(lost.code == 2);
  CHECK(has(lost.err, "but run.vtkhdf is missing; give a later time.end, or start again with"));
  folder.write("c/run.vtkhdf", "no such file");
  CHECK(has(with("c", "0.002").err, "but run.vtkhdf cannot be read; give a later time.end"));
  fs::rename(folder / "c/kept", folder / "c/run.vtkhdf");
  // Ahead of the checkpoint: it ends there, and the note says so.
  const double reached = pbf::RunReader((folder / "c/run.vtkhdf").string()).times().back();
  const Outcome earlier = with("c", std::to_string(reached + 0.1));
  CAPTURE(earlier.err);
  CHECK(earlier.code == 0);
  CHECK(has(earlier.err, " s now, 80 s before: the run ends earlier"));
  CHECK(fs::exists(folder / "c/DONE"));
  CHECK_FALSE(has(with("b", "0.3").err, "ends earlier"));  // prolonged
}

TEST_CASE("a killed run that ends earlier says that frames beyond its end are removed") {
  const Scratch folder;
  write_scene(folder);
  const Args args{"run", "s.yaml", "--out", "b", "--quiet", "--threads", "1"};
  CHECK(end_by(folder, args, SIGKILL, 12).code == 128 + SIGKILL);
  const std::int64_t frames = pbf::RunReader((folder / "b/run.vtkhdf").string()).frames();
  const Outcome o = pbf::test::pbf(
      {"run", "s.yaml", "--out", "b", "--threads", "1", "--resume", "--set", "time.end=0.05"},
      folder.path());
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK(has(o.err, "; " + std::to_string(frames - 6) + " frames of run.vtkhdf beyond it are "));
  CHECK(pbf::RunReader((folder / "b/run.vtkhdf").string()).frames() == 6);
}

TEST_CASE("a run of an earlier version, whose log lacks a column, is refused by name") {
  const Scratch folder;
  write_scene(folder);
  REQUIRE(run_scene(folder, "b", {"--set", "time.end=0.1"}).code == 0);
  {
    const hid_t file =
        H5Fopen((folder / "b/run.vtkhdf").string().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    REQUIRE(file >= 0);
    CHECK(H5Ldelete(file, "pbf/log/unresolved", H5P_DEFAULT) >= 0);
    CHECK(H5Fclose(file) >= 0);
  }
  const Outcome o = run_scene(folder, "b", {"--set", "time.end=0.2", "--resume"});
  CHECK(o.code == 2);
  CHECK(has(o.err, "whose log has no column unresolved"));
  CHECK(has(o.err, "--overwrite"));
}

TEST_CASE("changed physics keys are an error that names them all and the remedy, others may change",
          "[slow]") {
  const Scratch folder;
  write_scene(folder);
  REQUIRE(run_scene(folder, "b", {"--max-walltime", "0.02"}).code == 75);
  const std::vector<std::pair<std::string, std::string>> bad{
      {"solver.iterations=5", "solver.iterations: 4 before, 5 now"},
      {"viscosity=off", "viscosity: on before, off now"},
      {"bodies.0.max=[0.4,0.6,0.7]", "bodies[0].max"},
      {"precision=double", "precision: float before, double now"},
      {"output.every=0.02", "output.every"}};
  Args all{"--resume"};
  const auto remedy = [](const std::string& said) {
    return has(said, ". Give the same scene, files and --set options as at the start") &&
           has(said, "in another folder with --out, or in this one with --overwrite");
  };
  for (const auto& [set, text] : bad) {
    const Outcome o = run_scene(folder, "b", {"--resume", "--set", set});
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(has(o.err, text));
    CHECK(remedy(o.err));
    all.insert(all.end(), {"--set", set});
  }
  const Outcome o = run_scene(folder, "b", all);
  CAPTURE(o.err);
  CHECK(o.code == 2);
  for (const auto& [set, text] : bad) CHECK(has(o.err, text));
  CHECK(remedy(o.err));
  CHECK(run_scene(folder, "b",
                  {"--resume", "--set", "threads=2", "--set", "checkpoint.every=5", "--set",
                   "time.end=0.9", "--set", "name=other"})
            .code == 0);
}

TEST_CASE("a damaged checkpoint is told and the one before it is taken", "[slow]") {
  const Scratch folder;
  write_scene(folder);
  REQUIRE(run_scene(folder, "a", {}).code == 0);
  REQUIRE(run_scene(folder, "b", {"--max-walltime", "0.1"}).code == 75);
  REQUIRE(run_scene(folder, "b", {"--max-walltime", "0.1", "--resume"}).code == 75);
  REQUIRE(fs::exists(folder / "b/checkpoint_prev.h5"));
  const fs::path newest = folder / "b/checkpoint.h5";
  std::string bytes = read_text(newest);
  const std::size_t place = middle_of(newest, "position");
  bytes[place] = char(bytes[place] ^ 16);
  folder.write("b/checkpoint.h5", bytes);
  const Outcome o =
      pbf::test::pbf({"run", "s.yaml", "--out", "b", "--threads", "1", "--resume"}, folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 0);
  CHECK(has(o.err, "cannot be read"));
  CHECK(difference(folder, "a", "b") == "");
  // Both damaged: no silent start from the beginning.
  REQUIRE(run_scene(folder, "c", {"--max-walltime", "0.1"}).code == 75);
  fs::resize_file(folder / "c/checkpoint.h5", 1000);
  const Outcome none = run_scene(folder, "c", {"--resume"});
  CHECK(none.code == 5);
  CHECK(has(none.err, "checkpoint.h5"));
  CHECK(has(none.err, "remove it"));
}

TEST_CASE("a run that is killed at its start leaves no process behind that holds its folder",
          "[slow]") {
  const Scratch folder;
  write_scene(folder);
  const Args args{"run",       "s.yaml", "--out",          "b",   "--resume", "--quiet",
                  "--threads", "1",      "--max-walltime", "0.1", "--set",    "time.end=90"};
  REQUIRE(pbf::test::pbf(args, folder.path()).code == 75);
  for (int k = 0; k < 25; ++k) {  // where it tries its file in a process apart
    CAPTURE(k);
    Process p(args, folder.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(4 + k));
    p.send(SIGKILL);
    const int killed = p.wait().code;
    REQUIRE((killed == 128 + SIGKILL || killed == 75));
    const Outcome next = pbf::test::pbf(args, folder.path());
    CAPTURE(next.err);
    REQUIRE(next.code == 75);
  }
}

TEST_CASE("two runs cannot write to one folder", "[slow]") {
  const Scratch folder;
  write_scene(folder);
  Process first({"run", "s.yaml", "--out", "b", "--quiet", "--set", "time.end=1000"},
                folder.path());
  for (int i = 0; i < 500 && !fs::exists(folder / "b/run.vtkhdf"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const Scratch other;  // its own stderr
  for (const char* how : {"--resume", "--overwrite"}) {
    const Outcome o = pbf::test::pbf(
        {"run", (folder / "s.yaml").string(), "--out", (folder / "b").string(), how}, other.path());
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(has(o.err, "another run writes here (process " + std::to_string(first.id())));
  }
  first.send(SIGKILL);
  first.wait();
  CHECK(run_scene(folder, "b", {"--overwrite"}).code == 0);  // the lock went with the process
  CHECK_FALSE(fs::exists(folder / "b/.lock"));
}

TEST_CASE("a run file runs again to the same bytes", "[slow]") {
  const Scratch folder;
  write_scene(folder);
  REQUIRE(run_scene(folder, "a", {"--set", "solver.iterations=2"}).code == 0);
  const Outcome o = pbf::test::pbf({"run", "a/run.vtkhdf", "--out", "b", "--quiet"}, folder.path());
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK(difference(folder, "a", "b") == "");
  folder.write("x.h5", std::string("\x89HDF\r\n\x1a\n", 8) + "and nothing else");
  CHECK(pbf::test::pbf({"run", "x.h5"}, folder.path()).code == 5);
}
