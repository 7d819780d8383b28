// Links, FIFOs, devices and folders under the names of files that a run writes and reads.
#include <sys/stat.h>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

const char* const kNames[] = {"log.txt",        "run.vtkhdf",        "scene.resolved.yaml",
                              "checkpoint.h5",  "checkpoint.h5.tmp", "checkpoint_prev.h5",
                              "guard_state.h5", "guard_scene.yaml",  "run.damaged.vtkhdf",
                              "frames"};

/// A folder as a run that was killed before its first update leaves it.
void begin(const Scratch& folder) {
  folder.write("tiny.yaml", tiny_scene());
  folder.write("victim", "precious");
  fs::create_directory(folder / "o");
}

Outcome resume(const Scratch& folder) {
  return shell("timeout -k 1 20 \"$PBF\" run tiny.yaml --out o --resume", folder.path());
}

}  // namespace

TEST_CASE("a link in a run folder is not followed, and the error names it and the remedy",
          "[slow]") {
  for (const std::string name : kNames) {
    for (const std::string target : {"../victim", "../new"}) {
      const Scratch folder;
      begin(folder);
      fs::create_symlink(target, folder / "o" / name);
      const Outcome o = resume(folder);
      CAPTURE(name, target, o.err);
      CHECK(o.code == 5);
      CHECK(has(o.err, "o/" + name + ": is a link to " + target + ", and in a folder of results"));
      CHECK(has(o.err, "; remove it, or give another folder with --out"));
      CHECK(read_text(folder / "victim") == "precious");
      CHECK_FALSE(fs::exists(folder / "new"));
    }
  }
  const Scratch folder;
  begin(folder);
  fs::create_symlink("../victim", folder / "o/.lock");
  const Outcome o = resume(folder);
  CHECK(o.code == 5);
  CHECK(has(o.err, "o/.lock: is a link to ../victim"));
  CHECK(read_text(folder / "victim") == "precious");
}

TEST_CASE("a FIFO and a folder in a run folder are errors, and nothing hangs", "[slow]") {
  for (const std::string name : kNames) {
    const Scratch folder;
    begin(folder);
    REQUIRE(mkfifo((folder / "o" / name).c_str(), 0600) == 0);
    const Outcome o = resume(folder);
    CAPTURE(name, o.err);
    CHECK(o.code == 5);
    CHECK(has(o.err, "o/" + name + ": is a FIFO, and in a folder of results"));
    if (name == "frames") continue;
    fs::remove(folder / "o" / name);
    fs::create_directory(folder / "o" / name);
    const Outcome d = resume(folder);
    CHECK(d.code == 5);
    CHECK(has(d.err, "o/" + name + ": is a folder, and"));
  }
}

TEST_CASE(
    "an overwritten run folder loses links and FIFOs among the run's files, not what they lead "
    "to") {
  const Scratch folder;
  begin(folder);
  fs::create_directory(folder / "pictures");
  folder.write("pictures/frame_000001.png", "precious");
  for (const char* name : {"log.txt", "run.vtkhdf", "DONE"})
    fs::create_symlink("../victim", folder / "o" / name);
  REQUIRE(mkfifo((folder / "o/checkpoint.h5").c_str(), 0600) == 0);
  fs::create_directory_symlink("../pictures", folder / "o/frames");
  const Outcome o =
      shell("timeout -k 1 20 \"$PBF\" run tiny.yaml --out o --overwrite", folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 0);
  CHECK(read_text(folder / "victim") == "precious");
  CHECK(read_text(folder / "pictures/frame_000001.png") == "precious");
  CHECK(fs::is_regular_file(fs::symlink_status(folder / "o/run.vtkhdf")));
  CHECK_FALSE(fs::exists(fs::symlink_status(folder / "o/frames")));
}

TEST_CASE("a run folder that is reached by way of a link works") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  fs::create_directories(folder / "scratch/out");
  fs::create_directory_symlink("scratch/out", folder / "out");
  CHECK(shell("\"$PBF\" run tiny.yaml", folder.path()).code == 0);
  fs::create_directory_symlink("scratch/out/tiny", folder / "o");
  CHECK(shell("\"$PBF\" run tiny.yaml --out o --resume --set time.end=0.2", folder.path()).code ==
        0);
  CHECK(shell("\"$PBF\" run tiny.yaml --out o --overwrite", folder.path()).code == 0);
  CHECK(fs::is_regular_file(folder / "scratch/out/tiny/DONE"));
  CHECK(fs::is_symlink(folder / "o"));
}

TEST_CASE("tables and results of a folder of results are not written through links") {
  const Scratch folder;
  begin(folder);
  folder.write("few.yaml",
               "scene: tiny.yaml\nset: {output: off}\nrepeats: 1\n"
               "grid: [{solver.iterations: [2]}]\n");
  const auto refused = [&](const std::string& words, const std::string& file) {
    const Outcome o = shell("timeout -k 1 20 \"$PBF\" " + words, folder.path());
    CAPTURE(words, o.err);
    CHECK(o.code == 5);
    CHECK(has(o.err, file + ": is a "));
    CHECK(read_text(folder / "victim") == "precious");
  };
  fs::create_symlink("../victim", folder / "o/study.csv");
  refused("study few.yaml --out o", "o/study.csv");
  fs::remove(folder / "o/study.csv");
  REQUIRE(shell("\"$PBF\" study few.yaml --out o", folder.path()).code == 0);
  const fs::path member = fs::directory_iterator(folder / "o/members")->path();
  fs::remove(member);
  REQUIRE(mkfifo(member.c_str(), 0600) == 0);
  refused("study few.yaml --out o", "o/members/" + member.filename().string());
  fs::create_symlink("../victim", folder / "o/summary.csv");
  refused("batch tiny.yaml --out o", "o/summary.csv");
}

TEST_CASE("a FIFO where a run file or a particle file is expected is an error, and nothing hangs") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  REQUIRE(mkfifo((folder / "fifo.h5").c_str(), 0600) == 0);
  folder.write("of_file.yaml",
               "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
               "bodies: [{shape: file, path: fifo.h5}]\ntime: {step: 0.005, end: 0.01}\n");
  for (const char* words : {"render fifo.h5", "compare fifo.h5 fifo.h5", "run of_file.yaml"}) {
    const Outcome o = shell(std::string("timeout -k 1 20 \"$PBF\" ") + words, folder.path());
    CAPTURE(words, o.err);
    CHECK(o.code == 5);
    CHECK(has(o.err, "fifo.h5: "));
    CHECK(has(o.err, "is a FIFO, "));
  }
}
