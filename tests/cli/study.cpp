// pbf study as a user runs it: tables, going on after a stop, what cannot run here.
#include <csignal>
#include <thread>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// A folder with the tiny scene and a study of it.
struct Folder : Scratch {
  explicit Folder(const std::string& study) {
    write("tiny.yaml", tiny_scene());
    write("study.yaml", "scene: tiny.yaml\nset: {output: off, threads: 1}\n" + study);
  }
  Outcome run(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"study", "study.yaml", "--out", "o"});
    return pbf::test::pbf(more, path());
  }
};

}  // namespace

TEST_CASE("a study writes its tables, keeps its runs, and does only what is missing") {
  const Folder folder(
      "repeats: 2\ngrid: {solver.iterations: [1, 2], precision: [float, double]}\n");
  const Outcome first = folder.run();
  CAPTURE(first.err);
  REQUIRE(first.code == 0);
  CHECK(count(first.err, "kept from before") == 0);
  for (const char* part : {"Pareto", "cheapest setting for compression_mean <= 1 %", "* "})
    CHECK(has(first.out, part));
  const std::string csv = read_text(folder / "o/study.csv");
  CHECK(csv.rfind("solver.iterations,backend,precision,threads,particles,", 0) == 0);
  CHECK(count(csv, "\n") == 5);
  CHECK(count(csv, ",finished,") == 4);
  CHECK(count(csv, ",double,") == 2);
  CHECK(has(read_text(folder / "o/study.json"), "\"cheapest\""));

  const Outcome again = folder.run();
  CHECK(again.code == 0);
  CHECK(count(again.err, "kept from before") == 4);
  CHECK(again.out == first.out);
  CHECK(read_text(folder / "o/study.csv") == csv);
  fs::remove(fs::directory_iterator(folder / "o/members")->path());
  CHECK(count(folder.run().err, "kept from before") == 3);
  // A damaged result is said to be, and made again.
  const auto member = fs::directory_iterator(folder / "o/members")->path();
  folder.write("o/members/" + member.filename().string(), "{\"status\": ");
  const Outcome mended = folder.run();
  CHECK(mended.code == 0);
  CHECK(count(mended.err, "kept from before") == 3);
  CHECK(has(mended.err, "damaged"));
  // So is one whose columns are not those of a result.
  const auto changed = fs::directory_iterator(folder / "o/members")->path();
  std::string text = read_text(changed);
  text.replace(text.find("\"compression_mean\""), 18, "\"mean_compression\"");
  folder.write("o/members/" + changed.filename().string(), text);
  const Outcome remade = folder.run();
  CHECK(remade.code == 0);
  CHECK(count(remade.err, "kept from before") == 3);
  CHECK(has(remade.err, changed.filename().string()));
  CHECK(has(remade.err, "log has no column compression_mean"));
}

TEST_CASE("a killed study goes on where it was, and SIGTERM stops it with 75", "[slow]") {
  const Folder folder(
      "repeats: 1\ngrid: {solver.iterations: [1, 2, 3, 4, 5, 6]}\nset: {time.end: 1}\n");
  fs::remove(folder / "study.yaml");
  folder.write("study.yaml",
               "scene: tiny.yaml\nrepeats: 1\nset: {output: off, threads: 1, time.end: 8}\n"
               "grid: {solver.iterations: [1, 2, 3, 4, 5, 6]}\n");
  const auto until_one_is_done = [&](int signal) {
    Process study({"study", "study.yaml", "--out", "o"}, folder.path());
    const auto done = [&] {
      std::error_code none;
      std::ptrdiff_t n = 0;
      for (const auto& file : fs::directory_iterator(folder / "o/members", none))
        n += file.path().extension() == ".json";
      return n;
    };
    const auto before = fs::exists(folder / "o/members") ? done() : std::ptrdiff_t{0};
    for (int k = 0; k < 2000 && (!fs::exists(folder / "o/members") || done() <= before); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    study.send(signal);
    return study.wait();
  };
  CHECK(until_one_is_done(SIGKILL).code == 128 + SIGKILL);
  const Outcome stopped = until_one_is_done(SIGTERM);
  CAPTURE(stopped.err);
  CHECK(stopped.code == 75);
  CHECK(has(stopped.err, "kept from before"));
  CHECK(has(stopped.err, "stopped early by SIGTERM"));
  const Outcome rest = folder.run({"--set", "time.end=8"});
  CHECK(rest.code == 0);
  CHECK(count(rest.err, "kept from before") >= 2);
}

TEST_CASE("study --list makes nothing, and a wrong study exits 2 before anything is made") {
  const Folder folder("grid: {solver.iterations: [1, 2]}\n");
  const Outcome list = folder.run({"--list"});
  CHECK(list.code == 0);
  CHECK(has(list.out, "2 runs"));
  CHECK(has(list.out, "solver.iterations=2"));
  const Outcome bad = folder.run({"--set", "solver.iteratons=3"});
  CHECK(bad.code == 2);
  CHECK(has(bad.err, "did you mean solver.iterations?"));
  const Outcome missing = pbf::test::pbf({"study", "no.yaml"}, folder.path());
  CHECK(missing.code == 2);
  CHECK(has(missing.err, "no.yaml: cannot be opened"));
  CHECK_FALSE(fs::exists(folder / "o"));
  folder.write("file", "");
  const Outcome blocked = pbf::test::pbf({"study", "study.yaml", "--out", "file/o"}, folder.path());
  CHECK(blocked.code == 5);
}

TEST_CASE("a backend that is not here is a row that says so, and exit code 4") {
  const Folder folder("repeats: 1\ngrid: {backend: [cpu, cuda]}\n");
  const Outcome o = folder.run();
  const std::string csv = read_text(folder / "o/study.csv");
  CHECK(count(csv, "\n") == 3);
  CHECK(o.code == 4);
  CHECK(count(csv, ",finished,") == 1);
  CHECK(has(csv, "cuda,float,0,0,0,,"));
  CHECK(has(csv, ",unavailable,"));
  CHECK(has(o.err, "1 of 2 runs could not run here"));
  const Folder other(
      "repeats: 1\ngrid: {precision: [float, double]}\nreference: {backend: cuda}\n");
  const Outcome without = other.run();
  CHECK(without.code == 4);
  CHECK(has(without.err, "study.yaml:5:12: reference: cannot run here: "));
}

namespace {

/// 51 readings, at the same times for every step.
const char* const kMotion =
    "repeats: 1\nset:\n  gauges: [{name: H, kind: level, at: [0.1, 0.1]}]\n"
    "grid:\n  - {time.step: [0.004, 0.002, 0.001], measure_every: [1, 2, 4]}\n"
    "error:\n  - compression_mean\n  - {log: center_of_mass_x}\n  - {gauge: H}\n";

/// A study in which these errors are told, of a scene and a grid of three steps.
struct MotionFolder : Scratch {
  explicit MotionFolder(const std::string& study = kMotion) {
    write("tiny.yaml", tiny_scene());
    write("study.yaml", "scene: tiny.yaml\n" + study);
  }
  Outcome run(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"study", "study.yaml", "--out", "o", "--set", "output=off", "--set",
                               "threads=1", "--set", "time.end=0.2"});
    return pbf::test::pbf(more, path());
  }
};

}  // namespace

TEST_CASE("errors of motion have units and orders, and a study that goes on tells the same") {
  const MotionFolder folder;
  const Outcome list = folder.run({"--list"});
  CHECK(has(list.out, "time.step=0.001 (reference)"));
  CHECK(has(list.out, "3 runs\n"));
  const Outcome first = folder.run();
  CAPTURE(first.out, first.err);
  REQUIRE(first.code == 0);
  CHECK(has(first.err, "[3/3] time.step=0.001, reference"));
  CHECK(first.err.find("[3/3]") < first.err.find("[1/3]"));
  CHECK(count(first.err, "[3/3]") == count(first.err, "[3/3] time.step=0.001, reference"));
  for (const char* part :
       {"center_of_mass_x: difference from time.step=0.001, from 0 s on; range", " m, 51 points",
        "gauge/H: difference", "RMS, m", "the reference", "no order: no run with a longer step",
        "order 1 would show as 1.58, 2 as 2.32",
        "cheapest setting for gauge/H_rms_relative <= 1 %"})
    CHECK(has(first.out, part));
  const std::string csv = read_text(folder / "o/study.csv");
  CHECK(has(csv, ",center_of_mass_x_rms_m,center_of_mass_x_rms_relative,gauge/H_rms_m,"));
  CHECK(has(csv, ",center_of_mass_x_order,gauge/H_order,device,"));
  CHECK(has(read_text(folder / "o/study.json"), "\"note\": \"the reference\""));

  const Outcome again = folder.run();
  CHECK(again.out == first.out);
  CHECK(count(again.err, "kept from before") == 3);
  CHECK(read_text(folder / "o/study.csv") == csv);
  // Other errors are told of the same runs, those of a gauge too.
  folder.write("study.yaml", "scene: tiny.yaml\n" + std::string(kMotion) + "  - {log: energy}\n");
  const Outcome more = folder.run();
  CHECK(more.code == 0);
  CHECK(count(more.err, "kept from before") == 3);
  CHECK(has(more.out, "energy: difference"));
}

TEST_CASE("a reference that fails ends the study before its other runs, by name") {
  const MotionFolder folder(
      "repeats: 1\nset: {domain.open: [z_min], gravity: [0, 0, -1e12], time.step: 5e7}\n"
      "grid: {solver.iterations: [1, 2]}\nerror: {log: energy}\n");
  const Outcome o = folder.run({"--set", "time.end=1e9", "--set", "measure_every=1"});
  CAPTURE(o.err);
  CHECK(o.code == 2);
  CHECK(has(o.err, "study.yaml: reference: solver.iterations=2 diverged at update "));
  CHECK(has(o.err, "name another run"));
  CHECK_FALSE(has(o.err, "[1/2]"));
}

TEST_CASE("runs that cannot be compared keep their row with the reason, and the study exits 2") {
  const MotionFolder folder(
      "repeats: 1\nset:\n  domain.open: [z_max]\n"
      "  gauges: [{name: dry, kind: velocity, at: [0.8, 0.1, 0.38]}]\n"
      "grid:\n  - {time.step: [0.004, 0.002], measure_every: [1, 2]}\nerror: {gauge: dry/x}\n");
  const Outcome o = folder.run();
  CAPTURE(o.out, o.err);
  CHECK(o.code == 2);
  CHECK(has(o.err, "study.yaml: 2 of 2 runs could not be compared with the reference"));
  const std::string csv = read_text(folder / "o/study.csv");
  CHECK(count(csv, ",finished,gauge/dry/x: 0 of the reference's 0 readings can be compared") == 2);
  CHECK(count(o.out, "nan") == 0);
}
