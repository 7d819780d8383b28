// Files that the first edition (0.1.0, commit 145b3b4) has written: tests/samples/first_edition.
#include <cstdlib>
#include <filesystem>

#include "lib/io/checkpoint.h"
#include "lib/io/run_file.h"
#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;
namespace fs = std::filesystem;

namespace {

/// A copy of the samples, with the run file as it was written.
class Samples {
 public:
  Samples() {
    fs::copy(fs::path(PBF_SOURCE_DIR) / "tests/samples/first_edition", folder_.path(),
             fs::copy_options::recursive);
    REQUIRE(std::system(("gzip -d " + (folder_ / "run/run.h5.gz").string()).c_str()) == 0);
    std::string scene = read_text(folder_ / "tiny.yaml");
    for (const auto& [was, now] :
         {std::pair<std::string, std::string>{"relaxation", "cfm"}, {"step_length", "sor"}})
      scene.replace(scene.find(was), was.size(), now);
    folder_.write("new.yaml", scene);
  }
  Outcome pbf(const std::vector<std::string>& words) const {
    return pbf::test::pbf(words, folder_.path());
  }
  fs::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  Scratch folder_;
};

}  // namespace

TEST_CASE("a scene with keys of the first edition is refused with their new names") {
  const Samples s;
  const Outcome o = s.pbf({"plan", "tiny.yaml"});
  CHECK(o.code == 2);
  CHECK(has(o.err, "tiny.yaml:6:10: solver.relaxation: is called solver.cfm now; rename it"));
  CHECK(has(o.err, "tiny.yaml:6:29: solver.step_length: is called solver.sor now; rename it"));
  const Outcome set = s.pbf({"plan", "new.yaml", "--set", "solver.relaxation=1"});
  CHECK(set.code == 2);
  CHECK(has(set.err, "is called solver.cfm now"));
}

TEST_CASE("a run file of the first edition is read, drawn, compared and run again") {
  const Samples s;
  const pbf::RunReader run((s / "run/run.h5").string());
  CHECK(run.frames() == 6);
  CHECK(run.frame(5).count == 8);
  CHECK(run.log_column("compression_mean").size() == 11);
  CHECK(run.log_column("unresolved").empty());
  CHECK(run.info().warnings.empty());
  const Outcome same = s.pbf({"compare", "run/run.h5", "run/run.h5"});
  CAPTURE(same.err);
  CHECK(same.code == 0);
  const Outcome again = s.pbf({"run", "run/run.h5", "--out", "again"});
  CHECK(again.code == 0);
  CHECK(has(read_text(s / "again/scene.resolved.yaml"), "cfm: 0.001"));
#ifdef PBF_HAS_RENDER
  const Outcome pictures =
      s.pbf({"render", "run/run.h5", "--frames", "0", "--size", "64x64", "--out", "p"});
  CHECK((pictures.code == 0 || has(pictures.err, "none could be opened")));
#endif
}

TEST_CASE("a checkpoint of the first edition is read") {
  const Samples s;
  std::vector<std::string> notes;
  const auto saved = pbf::read_checkpoint((s / "run").string(), notes);
  REQUIRE(saved);
  CHECK(saved->particles == 8);
  CHECK(saved->state.updates == 50);
  CHECK(saved->state.position.size() == 24);
  CHECK(saved->scene.empty());
  CHECK(notes.empty());
}

TEST_CASE("a run of the first edition is not resumed, with or without its run file") {
  const Samples s;
  const std::vector<std::string> resume{"run", "new.yaml", "--out", "run", "--resume"};
  const Outcome with = s.pbf(resume);
  CHECK(with.code == 2);
  CHECK(has(with.err, "holds run.h5, as an earlier version of pbf called its run file"));
  fs::remove(s / "run/run.h5");
  fs::remove(s / "run/DONE");
  const Outcome without = s.pbf(resume);
  CHECK(without.code == 2);
  CHECK(has(without.err, "checkpoint.h5 is of an earlier version of pbf"));
  CHECK(fs::exists(s / "run/checkpoint.h5"));
  const Outcome over = s.pbf({"run", "new.yaml", "--out", "run", "--overwrite"});
  CHECK(over.code == 0);
  CHECK(!fs::exists(s / "run/run.damaged.h5"));
}

TEST_CASE("a study's store of the first edition stays, and its runs are made again") {
  const Samples s;
  const std::string before = read_text(s / "study/members/0b4f9b13665633e4.json");
  std::string study = read_text(s / "study.yaml");
  study.replace(study.find("tiny.yaml"), 9, "new.yaml");
  std::FILE* f = std::fopen((s / "study.yaml").c_str(), "w");
  std::fputs(study.c_str(), f);
  std::fclose(f);
  const Outcome o = s.pbf({"study", "study.yaml", "--out", "study"});
  CAPTURE(o.err);
  CHECK(o.code == 0);
  CHECK(has(o.err, "[2/2] "));
  CHECK(read_text(s / "study/members/0b4f9b13665633e4.json") == before);
}
