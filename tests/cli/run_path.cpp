// A run is given by its run file or by its folder, wherever one is read.
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// A run in out/tiny, which is where its scene goes by itself, and one in `b`.
struct Runs {
  Scratch folder;
  Runs() {
    folder.write("tiny.yaml", tiny_scene());
    for (const char* out : {"out/tiny", "b"})
      REQUIRE((*this)({"run", "tiny.yaml", "--out", out, "--quiet"}).code == 0);
  }
  Outcome operator()(const Args& args) const { return pbf::test::pbf(args, folder.path()); }
};

}  // namespace

TEST_CASE("run folder: every command that reads runs takes it for the run file in it", "[slow]") {
  const Runs pbf;
  CHECK(pbf({"plan", "b", "--resolved"}).out == pbf({"plan", "b/run.vtkhdf", "--resolved"}).out);
  CHECK(pbf({"plan", "b/"}).code == 0);
  CHECK(pbf({"run", "b", "--out", "again", "--quiet"}).code == 0);
  const Outcome same = pbf({"compare", "b", "again"});
  CHECK(same.code == 0);
  CHECK(has(same.out, "b/run.vtkhdf"));
  CHECK(pbf({"compare", "b/run.vtkhdf", "again", "--report", "again/run.vtkhdf"}).code == 2);
  CHECK(pbf({"compare", "b", "--between", "cpu:float@1,cpu:float@2", "--warmup", "1", "--updates",
             "2", "--members", "2", "--quiet"})
            .code == 0);
  CHECK(
      pbf({"bench", "b", "--n", "60", "--warmup", "0", "--updates", "1", "--repeats", "1"}).code ==
      0);
  const Outcome pictures = pbf({"render", "b", "--frames", "0", "--size", "32x32"});
  CHECK((pictures.code == 0 || pictures.code == 4));  // without OpenGL, or in a build without
  if (pictures.code == 0) CHECK(fs::exists(pbf.folder / "b/render/frame_000000.png"));
  pbf.folder.write("list", "b solver.iterations=2\nout/tiny\n");
  const Outcome batch = pbf({"batch", "list", "--out", "sweep", "--quiet"});
  CHECK(batch.code == 0);
  CHECK(fs::exists(pbf.folder / "sweep/b_iterations=2/DONE"));
  CHECK(fs::exists(pbf.folder / "sweep/tiny/DONE"));
}

TEST_CASE("run folder: with --resume the run goes on where it is, by its file too", "[slow]") {
  const Runs pbf;
  for (const char* given : {"b", "b/run.vtkhdf"}) {
    const Outcome o = pbf({"run", given, "--resume"});
    CHECK(o.code == 0);
    CHECK(has(o.err, "pbf: b: the run is finished"));
  }
  CHECK(pbf({"run", "b", "--resume", "--set", "time.end=0.2", "--quiet"}).code == 0);
  CHECK(has(read_text(pbf.folder / "b/scene.resolved.yaml"), "end: 0.2\n"));
  CHECK_FALSE(has(read_text(pbf.folder / "out/tiny/scene.resolved.yaml"), "end: 0.2\n"));
  // A copy of the file by itself is a scene as any other.
  fs::create_directory(pbf.folder / "copy");
  fs::copy(pbf.folder / "b/run.vtkhdf", pbf.folder / "copy/run.vtkhdf");
  CHECK(has(pbf({"run", "copy", "--resume", "--set", "time.end=0.1"}).err, "pbf: out/tiny: "));
}

TEST_CASE("run folder: a run is not repeated into its own folder") {
  const Runs pbf;
  const Outcome o = pbf({"run", "out/tiny"});
  CHECK(o.code == 2);
  CHECK(has(o.err,
            "out/tiny: holds the run that is to be repeated; give another folder with --out, or "
            "--resume to go on with it"));
}

TEST_CASE("run folder: without a run file it is said what is there", "[slow]") {
  const Runs pbf;
  fs::create_directory(pbf.folder / "empty");
  fs::create_directory(pbf.folder / "scenes");
  fs::create_directory(pbf.folder / "files");
  pbf.folder.write("scenes/one.yaml", tiny_scene());
  fs::copy(pbf.folder / "b/run.vtkhdf", pbf.folder / "files/other.vtkhdf");
  REQUIRE(pbf({"run", "tiny.yaml", "--out", "lean", "--set", "output=off", "--quiet"}).code == 0);
  const std::vector<std::pair<std::string, std::string>> cases{
      {"empty", "empty: no run.vtkhdf in this folder; name a scene or a run file"},
      {"out", "out: no run.vtkhdf in this folder, but in out/tiny; name that"},
      {"scenes",
       "scenes: no run.vtkhdf in this folder, but scenes/one.yaml; name one, or run all "
       "with pbf batch scenes"},
      {"files", "files: no run.vtkhdf in this folder, but files/other.vtkhdf; name the file"},
      {"lean", "lean: no run.vtkhdf in this folder: a run that writes no frames"}};
  for (const auto& [name, message] : cases)
    for (const Args& args :
         std::vector<Args>{{"run", name},
                           {"plan", name},
                           {"bench", name},
                           {"render", name},
                           {"compare", "b", name},
                           {"compare", name, "--between", "cpu:float,cpu:float"}}) {
      CAPTURE(args);
      const Outcome o = pbf(args);
      CHECK((o.code == 2 || (args[0] == "render" && o.code == 4)));
      if (o.code == 2) CHECK(has(o.err, message));
    }
  pbf.folder.write("list", "b\nempty\n");
  CHECK(has(pbf({"batch", "list"}).err, "list:2: empty: no run.vtkhdf in this folder"));
}

TEST_CASE("run folder: what is no run file in it is told as that, not as a scene or as missing",
          "[slow]") {
  const Runs pbf;
  for (const char* name : {"blank", "text", "linked", "folder", "pipe"})
    fs::create_directory(pbf.folder / name);
  pbf.folder.write("blank/run.vtkhdf", "");
  pbf.folder.write("text/run.vtkhdf", tiny_scene());
  fs::create_symlink("nowhere", pbf.folder / "linked/run.vtkhdf");
  fs::create_directory(pbf.folder / "folder/run.vtkhdf");
  REQUIRE(shell("mkfifo pipe/run.vtkhdf", pbf.folder.path()).code == 0);
  for (const auto& [name, reason] : std::vector<std::pair<std::string, std::string>>{
           {"blank", "it is empty"},
           {"text", "it is no HDF5 file"},
           {"linked", "No such file or directory"},
           {"folder", "it is a folder, not a regular file"},
           {"pipe", "it is a FIFO, not a regular file"}})
    for (const Args& args :
         std::vector<Args>{{"run", name}, {"plan", name}, {"compare", "b", name}}) {
      CAPTURE(args);
      const Outcome o = pbf(args);
      CHECK(o.code == 5);
      CHECK(has(o.err, name + "/run.vtkhdf: cannot read the run file: " + reason));
    }
}

TEST_CASE("run folder: one that is closed to the user is not said to hold no run") {
  const Runs pbf;
  const Outcome o = shell(
      "chmod 755 .; chmod 000 b; $STRANGER \"$PBF\" plan b; code=$?\n"
      "chmod 755 b; exit $code",
      pbf.folder.path());
  CHECK(o.code == 5);
  CHECK(has(o.err, "b/run.vtkhdf: cannot read the run file: Permission denied"));
}

TEST_CASE("run folder: a list in one takes it as ., called as the folder", "[slow]") {
  const Runs pbf;
  pbf.folder.write("b/list", ". solver.iterations=2\n../out/tiny/.\n");
  const Outcome o = pbf({"batch", "b/list", "--out", "sweep", "--quiet"});
  CHECK(o.code == 0);
  CHECK(fs::exists(pbf.folder / "sweep/b_iterations=2/DONE"));
  CHECK(fs::exists(pbf.folder / "sweep/tiny/DONE"));
  const Outcome inside =
      shell("cd b && \"$PBF\" batch list --out ../inside --quiet", pbf.folder.path());
  CHECK(inside.code == 0);
  CHECK(fs::exists(pbf.folder / "inside/b_iterations=2/DONE"));
}

TEST_CASE("run folder: a batch names its runs and its folder by that of the run, not by its file",
          "[slow]") {
  const Runs pbf;
  const Args twice = {"--grid", "time.step=0.01,0.005", "--set", "time.end=0.01", "--quiet"};
  for (const char* file : {"b/run.vtkhdf", "b/scene.resolved.yaml"}) {
    Args args = {"batch", file};
    args.insert(args.end(), twice.begin(), twice.end());
    CAPTURE(args);
    REQUIRE(pbf(args).code == 0);
    CHECK(fs::exists(pbf.folder / "out/batch_b/b_step=0.01/DONE"));
    fs::remove_all(pbf.folder / "out/batch_b");
  }
}

TEST_CASE("run folder: pbf batch takes folders of scenes, and says what one of a run is for") {
  const Runs pbf;
  const Outcome o = pbf({"batch", "b"});
  CHECK(o.code == 2);
  CHECK(has(o.err,
            "b: is the folder of a run, expected one of scenes; pbf run b --resume goes on with "
            "the run, and pbf batch b/run.vtkhdf --grid KEY=V1,V2 runs its scene"));
}

TEST_CASE("a file that is no run is told from a damaged one, and a scene from both") {
  const Runs pbf;
  pbf.folder.write("none.vtkhdf", "");
  for (const auto& [file, message] : std::vector<std::pair<std::string, std::string>>{
           {"tiny.yaml",
            "tiny.yaml: cannot read the run file: it is a scene, not a run; pbf run tiny.yaml "
            "simulates it"},
           {"none.vtkhdf", "none.vtkhdf: cannot read the run file: it is empty"},
           {"b/log.txt", "b/log.txt: cannot read the run file: it is no HDF5 file"}}) {
    const Outcome o = pbf({"compare", "b", file});
    CHECK(o.code == 5);
    CHECK(has(o.err, message));
  }
}

TEST_CASE("resume says where it looked for a run that is not there", "[slow]") {
  const Runs pbf;
  fs::remove_all(pbf.folder / "out");
  const Outcome o = pbf({"run", "tiny.yaml", "--resume"});
  CHECK(o.code == 0);
  CHECK(has(o.err,
            "pbf: out/tiny is not there: the run begins at its start; to go on with one that was "
            "begun with --out FOLDER, give the same --out\n"));
  const Outcome named = pbf({"run", "tiny.yaml", "--resume", "--out", "c"});
  CHECK(has(named.err, "pbf: c is not there: the run begins at its start\n"));
  CHECK_FALSE(has(pbf({"run", "tiny.yaml", "--resume"}).err, "is not there"));
}

TEST_CASE("a finished run without a checkpoint says that it is made again before it is") {
  const Runs pbf;
  const Outcome o = pbf({"run", "b", "--resume", "--set", "time.end=0.2"});
  CHECK(o.code == 0);
  CHECK(has(o.err,
            "pbf: the run is finished up to 0.1 s, but has kept no checkpoint: to reach time.end "
            "0.2 s it starts again from its first update; the 6 frames that are there stay. With "
            "checkpoint: {every: 60} in the scene a finished run can be prolonged\n"));
}

TEST_CASE("a folder without a run is not called one to replace or to go on with") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  fs::create_directory(folder / "a");
  const Outcome o = pbf::test::pbf({"run", "tiny.yaml", "--out", "a"}, folder.path());
  CHECK(o.code == 2);
  CHECK(has(o.err,
            "a: the output folder exists, without a run in it; give --overwrite to write "
            "into it beside what is there, or another folder with --out\n"));
}

TEST_CASE("a scene that is not there: one that comes with the program is named") {
  const Scratch folder;
  const Outcome o = pbf::test::pbf({"plan", "dam_break.yaml"}, folder.path());
  CHECK(o.code == 2);
  CHECK(has(o.err, "dam_break.yaml: cannot be opened: No such file or directory; "));
  CHECK(has(o.err, "configs/dam_break.yaml comes with pbf"));
}

TEST_CASE("a setting with spaces before its = says so") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const Outcome o = pbf::test::pbf({"plan", "tiny.yaml", "--set", "time.end = 0.1"}, folder.path());
  CHECK(o.code == 2);
  CHECK(has(o.err, "--set time.end = 0.1: has a space before the =; write KEY.PATH=VALUE"));
}
