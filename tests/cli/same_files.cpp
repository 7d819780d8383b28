// A run goes on, and runs again, with the scene and the particle files that it was begun with.
#include <cstdlib>
#include <functional>

#include "lib/io/h5.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"
#include "tests/support/same_run.h"

using namespace pbf::test;
namespace fs = std::filesystem;
namespace h5 = pbf::h5;

namespace {

const std::string kParticles = "x,y,z\n0.3,0.5,0.2\n0.4,0.5,0.2\n0.5,0.5,0.2\n0.3,0.5,0.3\n";

std::string scene_of(const std::string& path) {
  return "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
         "bodies: [{shape: file, path: " +
         path +
         "}]\ntime: {step: 0.005, end: 0.1}\noutput: {every: 0.02}\ncheckpoint: {every: 60}\n";
}

/// A scene of four particles from s/p.csv, run from the folder above it into a.
struct Ran {
  Scratch folder;
  Ran() {
    fs::create_directory(folder / "s");
    folder.write("s/p.csv", kParticles);
    folder.write("s/s.yaml", scene_of("p.csv"));
    const Outcome o = run({"s/s.yaml", "--out", "a"});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
  }
  Outcome run(const Args& more) const {
    Args args{"run"};
    args.insert(args.end(), more.begin(), more.end());
    args.insert(args.end(), {"--threads", "1"});
    return pbf::test::pbf(args, folder.path());
  }
  /// Another file of as many particles.
  void change_particles() const {
    std::string text = kParticles;
    text.replace(text.find("0.4"), 3, "0.6");
    folder.write("s/p.csv", text);
  }
  void edit(const std::string& file, const std::function<void(hid_t)>& action) const {
    const h5::Lock lock;
    const h5::File f(H5Fopen((folder / file).string().c_str(), H5F_ACC_RDWR, h5::file_access()));
    action(f);
  }
};

void check_refused(const Outcome& o, const Args& parts) {
  CAPTURE(o.err);
  CHECK(o.code == 2);
  for (const std::string& part : parts) CHECK(has(o.err, part));
}

void check_done(const Outcome& o, const std::string& note = {}) {
  CAPTURE(o.err);
  CHECK(o.code == 0);
  CHECK(has(o.err, note));
}

}  // namespace

TEST_CASE("a run file names the files of its scene as sha256sum checks them") {
  const Ran r;
  const pbf::RunInfo info = pbf::RunReader((r.folder / "a/run.vtkhdf").string()).info();
  r.folder.write("s/sums", info.scene_files);
  CHECK(has(info.scene_files, "  p.csv\n"));
  const std::string check = "cd " + (r.folder / "s").string() + " && sha256sum --quiet -c sums";
  CHECK(std::system(check.c_str()) == 0);
  r.folder.write("s/both", info.resolved_scene + info.scene_files);
  const std::string whole = "cd " + (r.folder / "s").string() + " && echo '" + info.scene_sha256 +
                            "  both' | sha256sum --quiet -c -";
  CHECK(std::system(whole.c_str()) == 0);
}

TEST_CASE("a run file runs again with the particle files of its run, and with no other", "[slow]") {
  const Ran r;
  check_done(r.run({"a/run.vtkhdf", "--out", "b"}));
  CHECK(run_difference(r.folder / "a/run.vtkhdf", r.folder / "b/run.vtkhdf") == "");
  check_done(r.run({"b/run.vtkhdf", "--out", "c"}));  // and that one again
  r.change_particles();
  check_refused(r.run({"a/run.vtkhdf", "--out", "d"}),
                {"a/run.vtkhdf: cannot run again: p.csv: its contents have changed: SHA-256 ",
                 "give the scene file itself"});
  CHECK_FALSE(fs::exists(r.folder / "d"));
  check_done(r.run({"s/s.yaml", "--out", "d"}));  // the remedy
  r.folder.write("s/q.csv", kParticles);          // another file that is asked for
  check_done(r.run({"a/run.vtkhdf", "--out", "e", "--set", "bodies.0.path=q.csv"}));
  CHECK(run_difference(r.folder / "a/run.vtkhdf", r.folder / "e/run.vtkhdf") == "");
}

TEST_CASE("a moved run file finds its particle files beside it, or says where it looked") {
  const Ran r;
  fs::create_directory(r.folder / "away");
  fs::rename(r.folder / "a/run.vtkhdf", r.folder / "away/run.vtkhdf");
  fs::rename(r.folder / "s/p.csv", r.folder / "away/p.csv");
  check_done(r.run({"away/run.vtkhdf", "--out", "b"}));
  fs::remove(r.folder / "away/p.csv");
  check_refused(r.run({"away/run.vtkhdf", "--out", "c"}),
                {"away/run.vtkhdf: its file p.csv is neither in s, ", " nor in away, ",
                 "--set bodies.0.path="});
}

TEST_CASE("a run file whose scene has been changed does not run again") {
  const Ran r;
  r.edit("a/run.vtkhdf", [](hid_t file) {
    const h5::Group pbf = h5::open_group(file, "pbf");
    std::string scene = h5::read_text(pbf, "resolved_scene");
    scene.replace(scene.find("step: 0.005"), 11, "step: 0.004");
    h5::write_text(pbf, "resolved_scene", scene);
  });
  check_refused(
      r.run({"a/run.vtkhdf", "--out", "b"}),
      {"a/run.vtkhdf: the scene in it", "has been changed since the run", "scene_sha256"});
}

TEST_CASE("a run file of an earlier version, without hashes, runs again with a note") {
  const Ran r;
  r.edit("a/run.vtkhdf", [](hid_t file) {
    const h5::Group pbf = h5::open_group(file, "pbf");
    h5::check(H5Adelete(pbf, "scene_sha256"));
    h5::check(H5Adelete(pbf, "scene_files"));
  });
  check_done(r.run({"a/run.vtkhdf", "--out", "b"}), "a/run.vtkhdf is of an earlier version");
}

TEST_CASE("a run is resumed with the particle files that it was begun with, done or not",
          "[slow]") {
  const Ran r;
  const Args again{"s/s.yaml", "--out", "a", "--resume"};
  check_done(r.run(again));
  Args longer = again;
  longer.insert(longer.end(), {"--set", "time.end=0.2"});
  r.change_particles();
  for (const Args& args : {again, longer})
    check_refused(r.run(args),
                  {"a: cannot resume: p.csv: its contents have changed: SHA-256 ", "--overwrite"});
  r.folder.write("s/p.csv", kParticles);
  check_done(r.run(longer));
  check_done(r.run({"a/run.vtkhdf", "--out", "b"}));  // what is kept of it follows the later end
  CHECK(run_difference(r.folder / "a/run.vtkhdf", r.folder / "b/run.vtkhdf") == "");
}

TEST_CASE("a checkpoint or run file of another scene with as many particles is refused", "[slow]") {
  const Ran r;
  check_done(r.run({"s/s.yaml", "--out", "b", "--set", "viscosity.xsph=0.1"}));
  const Args longer{"s/s.yaml", "--out", "a", "--resume", "--set", "time.end=0.2"};
  const std::string name = GENERATE("checkpoint.h5", "run.vtkhdf");
  fs::copy_file(r.folder / ("b/" + name), r.folder / ("a/" + name),
                fs::copy_options::overwrite_existing);
  check_refused(r.run(longer), {"a/" + name + ": cannot resume: it is of another scene: ",
                                "viscosity: on before, off now", "--overwrite"});
}

TEST_CASE("a checkpoint of other particle files is refused, with the file's name") {
  const Ran r;
  fs::copy(r.folder / "s", r.folder / "t");
  fs::copy_file(r.folder / "a/checkpoint.h5", r.folder / "old.h5");
  r.change_particles();
  check_done(r.run({"s/s.yaml", "--out", "a", "--overwrite"}));
  fs::copy_file(r.folder / "old.h5", r.folder / "a/checkpoint.h5",
                fs::copy_options::overwrite_existing);
  check_refused(r.run({"s/s.yaml", "--out", "a", "--resume", "--set", "time.end=0.2"}),
                {"a/checkpoint.h5: cannot resume: it is of another scene: p.csv: its contents have "
                 "changed"});
}

TEST_CASE("a checkpoint of an earlier version, without a scene, is refused by name") {
  const Ran r;
  r.edit("a/checkpoint.h5", [](hid_t file) {
    for (const char* name : {"scene_sha256", "scene_files", "resolved_scene"})
      h5::check(H5Adelete(file, name));
  });
  check_refused(r.run({"s/s.yaml", "--out", "a", "--resume", "--set", "time.end=0.2"}),
                {"checkpoint.h5 is of an earlier version", "--overwrite"});
}

TEST_CASE("what is no regular file is refused by every command that reads it, and none waits") {
  const Scratch folder;
  REQUIRE(std::system(("mkfifo " + (folder / "pipe").string()).c_str()) == 0);
  folder.write("s.yaml", scene_of("pipe"));
  for (const Args& args : {Args{"run", "s.yaml"}, Args{"plan", "s.yaml"}, Args{"render", "pipe"},
                           Args{"compare", "pipe", "pipe"}}) {
    const Outcome o = pbf::test::pbf(args, folder.path());
    CAPTURE(args[0], o.err);
    CHECK(o.code == 5);
    CHECK(has(o.err, "pipe"));
    CHECK(has(o.err, "a FIFO"));
  }
}
