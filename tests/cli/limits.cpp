// Limits of the system on a process: sizes of files, numbers of threads, closed streams.
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

bool cannot_run(const Outcome& o) { return o.code == 126 || o.code == 127; }

}  // namespace

TEST_CASE("a limit on the size of files is an error with exit code 5, and frames written stay") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const Outcome o = shell(
      "ulimit -f 2500; exec \"$PBF\" run tiny.yaml --set fluid.spacing=0.04 --set "
      "output.every=0.005",
      folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 5);
  CHECK(has(o.err, "run.vtkhdf: cannot write frame"));
  CHECK(has(o.err, "File too large; frames 0.."));
  CHECK(has(read_text(folder / "out/tiny/log.txt"), "File too large"));
  CHECK_FALSE(fs::exists(folder / "out/tiny/DONE"));
  const pbf::RunReader reader((folder / "out/tiny/run.vtkhdf").string());
  REQUIRE(reader.frames() > 1);
  CHECK(reader.frame(reader.frames() - 1).count > 0);
}

TEST_CASE("the limit on the size of files reaches every kind of file as an error") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const std::string bench = "bench --n 64 --updates 1 --warmup 1 --repeats 1 ";
  const std::pair<const char*, std::string> cases[] = {
      {"0", "run tiny.yaml --out a"},
      {"20", "run tiny.yaml --out b"},
      {"1", "run tiny.yaml --out c --set output=off --set measure_every=1 --log-json m.json"},
      {"0", bench + "--csv t.csv"},
      {"0", bench + "--json t.json"},
      {"0", "batch tiny.yaml --out d --collect"},
      {"8", "run tiny.yaml --out e --set output=off --set checkpoint.every=0.001"}};
  for (const auto& [blocks, words] : cases) {
    const Outcome o = shell("(ulimit -f " + std::string(blocks) + "; exec \"$PBF\" " + words +
                                ") 2>&1 | cat; exit ${PIPESTATUS[0]}",
                            folder.path());
    CAPTURE(blocks, words, o.out);
    CHECK(o.code == 5);
    CHECK(has(o.out, "File too large"));
  }
  CHECK_FALSE(fs::exists(folder / "t.csv"));
}

TEST_CASE("where no thread can be started, the error names the limit and the remedy", "[slow]") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  REQUIRE(shell("chmod 777 .", folder.path()).code == 0);
  const auto run = [&](const std::string& words) {
    return shell("ulimit -u 1; exec $STRANGER \"$PBF\" " + words, folder.path());
  };
  if (cannot_run(run("--version"))) PBF_SKIP("the program cannot be run as another user");
  const char* const cases[] = {
      "run tiny.yaml --threads 2 --out a",  // before it runs
      "run tiny.yaml --threads 2 --out b --set output=off --set fluid.spacing=0.03",  // OpenMP
      "run tiny.yaml --threads 1 --out c",                                            // the writer
      "batch tiny.yaml --out d"};
  for (const char* words : cases) {
    const Outcome o = run(words);
    CAPTURE(words, o.err);
    CHECK(o.code == 4);
    CHECK(has(o.err, "Resource temporarily unavailable; raise the limit on processes (ulimit -u"));
    CHECK((has(o.err, "--threads") || has(o.err, "--jobs")));
    CHECK_FALSE(has(o.err, "internal error"));
  }
  CHECK_FALSE(fs::exists(folder / "a"));
  // Without a need for a second thread there is none.
  CHECK(run("run tiny.yaml --threads 1 --out e --set output=off").code == 0);
#ifdef PBF_HAS_RENDER
  // Mesa would wait for threads that it could not start.
  REQUIRE(shell("\"$PBF\" run tiny.yaml --out f && chmod -R a+rX f", folder.path()).code == 0);
  const Outcome pictures = run("render f/run.vtkhdf --frames 0 --size 64x64 --out p");
  CAPTURE(pictures.err);
  CHECK((pictures.code == 0 || has(pictures.err, "none could be opened")));
#endif
  // The sources may be where a stranger cannot read.
  REQUIRE(shell(std::string("cp -r '") + PBF_SOURCE_DIR + "/configs' . && chmod -R a+rX configs",
                folder.path())
              .code == 0);
  const Outcome suite =
      run("stability step_0.01_iterations_1 step_0.01_iterations_2 --jobs 4 --reduced "
          "--suite configs/stability.yaml");
  CAPTURE(suite.err);
  CHECK(suite.code == 0);
}

TEST_CASE("results that a closed or full standard output loses are an error, not a crash") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  for (const char* words :
       {"run tiny.yaml --out a", "plan tiny.yaml", "config --schema", "--help", "--version", "info",
        "bench --n 64 --updates 1 --warmup 1 --repeats 1"}) {
    for (const char* where : {">&-", "> /dev/full"}) {
      const Outcome o =
          shell("rm -rf a; \"$PBF\" " + std::string(words) + " " + where, folder.path());
      CAPTURE(words, where, o.err);
      CHECK(o.code == 5);
      CHECK(has(o.err, where[1] == '&' ? "standard output is closed"
                                       : "standard output cannot be written: No space left"));
    }
  }
  CHECK(shell("\"$PBF\" run tiny.yaml --out b > /dev/full", folder.path()).code == 5);
  CHECK(fs::exists(folder / "b/DONE"));  // what lies in files is complete
}

TEST_CASE("no file of a run gets what is meant for a closed stream") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  const Outcome o = shell(
      "\"$PBF\" run tiny.yaml --threads 1 --out a --log-json a.json > /dev/null && \"$PBF\" run "
      "tiny.yaml --threads 1 --out b --log-json b.json <&- >&- 2>&-",
      folder.path());
  CHECK(o.code == 5);
  CHECK(fs::exists(folder / "b/DONE"));
  CHECK(fs::file_size(folder / "a/run.vtkhdf") == fs::file_size(folder / "b/run.vtkhdf"));
  for (const char* name : {"b.json", "b/scene.resolved.yaml", "b/DONE"})
    CHECK_FALSE(has(read_text(folder / name), "particles  "));
  CHECK(shell("\"$PBF\" run tiny.yaml --threads 1 --out c 2>&- > /dev/null", folder.path()).code ==
        0);
}
