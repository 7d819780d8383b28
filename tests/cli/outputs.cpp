// Files that the user names for tables, reports and measures: what they replace, and what not.
#include <sys/stat.h>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

const std::string kBench = "\"$PBF\" bench --n 64 --updates 1 --warmup 1 --repeats 1 ";

std::string tiny_study() {
  return "scene: tiny.yaml\nset: {output: off}\nrepeats: 1\ngrid:\n  - {solver.iterations: [2, "
         "3]}\n";
}

std::size_t lines_of(const std::string& text) {
  return std::size_t(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("a table goes into a device, which stays one") {
  const Scratch folder;
  // As root copies of devices: the defect would cost the machine its own.
  const std::string make = geteuid() == 0 ? "mknod null c 1 3 && mknod full c 1 7 || exit 126\n"
                                          : "ln -s /dev/null null; ln -s /dev/full full\n";
  const Outcome o = shell(make + kBench + "--csv null --json null && test -c null", folder.path());
  CAPTURE(o.err);
  if (o.code == 126) PBF_SKIP("no right to make devices");
  CHECK(o.code == 0);
  const Outcome full = shell(kBench + "--csv full", folder.path());
  CHECK(full.code == 5);
  CHECK(has(full.err, "full: cannot write the file: No space left on device"));
}

TEST_CASE("a table goes where a link leads, also to a file that is not there yet") {
  const Scratch folder;
  fs::create_directory(folder / "data");
  folder.write("data/old.csv", "old");
  fs::create_symlink("data/old.csv", folder / "a.csv");
  fs::create_symlink("data/new.csv", folder / "b.csv");
  fs::create_symlink("itself.csv", folder / "itself.csv");
  const Outcome o = shell(kBench + "--csv a.csv --json b.csv", folder.path());
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK(fs::is_symlink(folder / "a.csv"));
  CHECK(fs::is_symlink(folder / "b.csv"));
  CHECK(has(read_text(folder / "data/old.csv"), "scene,backend"));
  CHECK(has(read_text(folder / "data/new.csv"), "\"backend\": \"cpu\""));
  const Outcome loop = shell(kBench + "--csv itself.csv", folder.path());
  CHECK(loop.code == 5);
  CHECK(has(loop.err, "--csv itself.csv: the link leads to itself"));
}

TEST_CASE("a table goes once and whole into pipes, FIFOs with a reader and descriptors") {
  const Scratch folder;
  const Outcome o =
      shell("mkfifo fifo; cat fifo > read_fifo & " + kBench +
                "--csv fifo --json >(cat > read_pipe);\n" + "ln -s /proc/self/fd/1 out; " + kBench +
                "--csv out > redirected; " + kBench + "--csv /dev/fd/7 7> seven\n" + kBench +
                "--csv >(head -c 1 > one); echo code $?; wait; sleep 0.1",
            folder.path());
  CAPTURE(o.err);
  CHECK(o.code == 0);
  CHECK(o.err.empty());
  CHECK(lines_of(read_text(folder / "read_fifo")) == 3);  // a head and two rows
  CHECK(has(read_text(folder / "read_pipe"), "\"n_particles\": 64"));
  CHECK(lines_of(read_text(folder / "seven")) == 3);
  const std::string both = read_text(folder / "redirected");  // beside what is printed there
  CHECK(lines_of(both) == 5);
  CHECK(has(both, "scene,backend"));
  CHECK(has(o.out, "code 0"));  // a reader that has gone is no error
  CHECK(read_text(folder / "one") == "s");
}

TEST_CASE("a FIFO that nobody reads, a folder and a folder that is not there are errors") {
  const Scratch folder;
  fs::create_directory(folder / "sub");
  REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  const std::pair<const char*, const char*> cases[] = {
      {"fifo", "fifo: is a FIFO that nobody reads; start its reader first"},
      {"sub", "--csv sub: cannot be written: is a folder"},
      {"no/a.csv", "--csv no/a.csv: its folder no cannot be written: No such file or directory"}};
  for (const auto& [path, text] : cases) {
    const Outcome o = shell(kBench + "--csv " + path, folder.path());
    CAPTURE(path, o.err);
    CHECK(o.code == 5);
    CHECK(has(o.err, text));
  }
  const Outcome json = shell("timeout 20 \"$PBF\" run tiny.yaml --log-json fifo", folder.path());
  CHECK(json.code != 124);
}

TEST_CASE("a replaced table keeps the rights of the old one, a new one follows the umask") {
  const Scratch folder;
  folder.write("private.csv", "old");
  fs::permissions(folder / "private.csv", fs::perms::owner_read | fs::perms::owner_write);
  const Outcome o = shell("umask 027; " + kBench + "--csv private.csv --json new", folder.path());
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK((fs::status(folder / "private.csv").permissions() & fs::perms::mask) == fs::perms(0600));
  CHECK((fs::status(folder / "new").permissions() & fs::perms::mask) == fs::perms(0640));
}

TEST_CASE("a folder that cannot be written is told before the work, with exit code 5") {
  const Scratch folder;
  const Outcome o = shell(
      "chmod 777 .; mkdir closed; chmod 555 closed; $STRANGER " + kBench + "--csv closed/a.csv",
      folder.path());
  CAPTURE(o.err);
  if (o.code == 126 || o.code == 127) PBF_SKIP("the program cannot be run as another user");
  CHECK(o.code == 5);
  CHECK(o.out.empty());
  CHECK(has(o.err, "--csv closed/a.csv: its folder closed cannot be written: Permission denied"));
}

TEST_CASE("no output takes the place of a file that the command reads", "[slow]") {
  const Scratch folder;
  const std::string csv = "x,y,z\n0.5,0.5,0.5\n0.7,0.5,0.5\n";
  folder.write("points.csv", csv);
  folder.write("tiny.yaml", tiny_scene());
  folder.write("of_file.yaml",
               "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
               "bodies: [{shape: file, path: points.csv}]\ntime: {step: 0.005, end: 0.01}\n");
  fs::create_directory(folder / "s");
  folder.write("s/study.json", "{scene: ../tiny.yaml, grid: [{solver.iterations: [2]}]}");
  folder.write("scene.json", tiny_scene());
  folder.write("summary.csv", "tiny.yaml\n");
  folder.write("suite.yaml", read_text(std::string(PBF_SOURCE_DIR) + "/configs/stability.yaml"));
  fs::create_hard_link(folder / "tiny.yaml", folder / "hard.json");
  fs::create_symlink("tiny.yaml", folder / "soft.json");
  REQUIRE(shell("\"$PBF\" run tiny.yaml --out made", folder.path()).code == 0);
  REQUIRE(shell("ln made/run.vtkhdf run.json", folder.path()).code == 0);
  const std::pair<const char*, const char*> cases[] = {
      {"run tiny.yaml --log-json tiny.yaml", "tiny.yaml"},
      {"run tiny.yaml --log-json ./hard.json", "tiny.yaml"},
      {"run tiny.yaml --log-json soft.json", "tiny.yaml"},
      {"run of_file.yaml --log-json points.csv", "points.csv"},
      {"run made/run.vtkhdf --out again --log-json run.json", "made/run.vtkhdf"},
      {"run made/run.vtkhdf --out made --overwrite", "made/run.vtkhdf"},
      {"run made/scene.resolved.yaml --out made --overwrite", "made/scene.resolved.yaml"},
      {"bench tiny.yaml --csv tiny.yaml", "tiny.yaml"},
      {"bench tiny.yaml --json soft.json", "tiny.yaml"},
      {"stability --suite suite.yaml --csv suite.yaml", "suite.yaml"},
      {"stability tiny.yaml --map time.step,gravity --csv tiny.yaml", "tiny.yaml"},
      {"compare scene.json --between cpu:double,cpu:float --report scene.json", "scene.json"},
      {"compare made/run.vtkhdf made/run.vtkhdf --report run.json", "made/run.vtkhdf"},
      {"study s/study.json --out s", "s/study.json"},
      {"batch summary.csv --out .", "summary.csv"}};
  const std::string snapshot = "find . -type f ! -name '.std*' | sort | xargs sha256sum";
  const std::string before = shell(snapshot, folder.path()).out;
  for (const auto& [words, input] : cases) {
    const Outcome o = shell("\"$PBF\" " + std::string(words), folder.path());
    CAPTURE(words, o.err);
    CHECK(o.code == 2);
    CHECK(has(o.err, input));
    CHECK((has(o.err, "which this command reads and would overwrite; give another name") ||
           has(o.err, "which this run reads; give another folder with --out")));
  }
  CHECK(shell(snapshot, folder.path()).out == before);
}

TEST_CASE("the measures of a run go into none of its own files, two tables not into one") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  for (const char* name : {"out/tiny/log.txt", "out/../out/tiny/run.vtkhdf", "out/tiny/DONE"}) {
    const Outcome o =
        shell(std::string("\"$PBF\" run tiny.yaml --log-json ") + name, folder.path());
    CAPTURE(name, o.err);
    CHECK(o.code == 2);
    CHECK(has(o.err, "the run itself writes this file; give another name"));
  }
  CHECK_FALSE(fs::exists(folder / "out"));
  const Outcome o = shell(kBench + "--csv a --json ./a", folder.path());
  CHECK(o.code == 2);
  CHECK(has(o.err, "--csv and --json name one file"));
}

TEST_CASE(
    "measures follow a link and go to a pipe, and a reader that has gone does not end the run") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  fs::create_symlink("real.json", folder / "m.json");
  const Outcome o = shell(
      "\"$PBF\" run tiny.yaml --log-json m.json --out a && \"$PBF\" run tiny.yaml --out b "
      "--log-json >(cat > piped) && \"$PBF\" run tiny.yaml --out c --set measure_every=1 "
      "--log-json >(true); echo code $?; wait; sleep 0.1",
      folder.path());
  CAPTURE(o.err);
  CHECK(has(o.out, "code 0"));
  CHECK(fs::is_symlink(folder / "m.json"));
  CHECK(lines_of(read_text(folder / "real.json")) == 3);
  CHECK(lines_of(read_text(folder / "piped")) == 3);
}

TEST_CASE("studies and calibrations at the same time do not get into each other's way") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  folder.write("few.yaml", tiny_study());
  const Outcome o = shell(
      "export PBF_CALIBRATION=$PWD/c.csv\nfor k in 1 2 3 4 5 6; do\n"
      "  \"$PBF\" study few.yaml --out s --quiet > /dev/null & all=\"$all $!\"\n"
      "  \"$PBF\" bench --calibrate --n $((k * 64)) --updates 1 --warmup 1 --repeats 1 > /dev/null "
      "& all=\"$all $!\"\n"
      "done\n"
      "bad=0; for p in $all; do wait $p || bad=$((bad + 1)); done; echo bad $bad\n",
      folder.path());
  CAPTURE(o.err);
  CHECK(has(o.out, "bad 0"));
  CHECK(lines_of(read_text(folder / "s/study.csv")) == 3);
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    CHECK(entry.path().filename().string().rfind(".pbf-", 0) != 0);  // nothing is left behind
}

TEST_CASE("calibrations made at the same time are all kept") {
  const Scratch folder;
  const Outcome o = shell(
      "export PBF_CALIBRATION=$PWD/c.csv\n"
      "for k in 1 2 3 4 5 6 7 8; do \"$PBF\" bench --calibrate --n $((k * k * k)) --updates 1 "
      "--warmup 1 --repeats 1 > /dev/null || echo bad & done; wait; cut -d, -f5 c.csv | sort -u | "
      "wc -l",
      folder.path());
  CAPTURE(o.err, o.out);
  CHECK(o.out == "9\n");  // the head and eight numbers of particles
}
