// What the summary of a run says, and of which runs; that of a batch.
#include <sstream>

#include "tests/support/catch.h"
#include "tests/support/process.h"

using namespace pbf::test;

namespace {

std::string narrow_tank(const std::string& width, const std::string& end) {
  return "domain: {min: [0, 0, 0], max: [" + width +
         ", 0.2, 0.5]}\nfluid: {spacing: 0.05}\nbodies:\n"
         "  - {shape: block, min: [0, 0, 0], max: [0.2, 0.2, 0.4]}\ntime: {step: 0.005, end: " +
         end + "}\noutput: {}\n";
}

std::string summary_of(const std::string& scene, const Args& more = {}) {
  const Scratch folder;
  folder.write("s.yaml", scene);
  const Outcome o = run_scene(folder, "a", more);
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  return o.out;
}

}  // namespace

TEST_CASE("summary: the height and pressure of a pool are told of one that has come to rest",
          "[slow]") {
  CHECK(has(summary_of(narrow_tank("0.2", "4")), "pool at rest        height "));
  CHECK_FALSE(has(summary_of(narrow_tank("0.2", "0.02")), "pool at rest"));  // had no time to move
  CHECK_FALSE(has(summary_of(narrow_tank("1", "0.5")), "pool at rest"));     // flows
}

TEST_CASE("summary: what took energy is what the scene has, and walls have no friction", "[slow]") {
  const auto lost = [](const std::string& scene, const std::vector<std::string>& more = {}) {
    const std::string all = summary_of(scene, more);
    const std::size_t at = all.find("  lost ");
    REQUIRE(at != all.npos);
    CHECK_FALSE(has(all, "friction"));
    return all.substr(at, all.find('\n', at) - at);
  };
  const std::string tank = narrow_tank("1", "0.3");
  const std::string plain = lost(tank, {"--set", "solver.hyperviscosity=0"});
  CHECK_FALSE(has(plain, " by hyperviscosity"));
  CHECK(has(plain, ": 100 % in splashes and by the length of the steps"));
  CHECK(has(lost(tank), " % by hyperviscosity, "));
  const std::string both =
      lost(tank + "viscosity: {}\n", {"--set", "solver.velocity_damping=0.99"});
  CHECK(has(both, " % by viscosity, "));
  CHECK(has(both, " % by damping, "));
}

TEST_CASE("summary: where no energy is lost nothing is named that takes it") {
  const std::string flies = summary_of(
      "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\ngravity: [0, 0, 0]\n"
      "bodies: [{shape: block, min: [0.3, 0.3, 0.3], max: [0.6, 0.6, 0.6], velocity: [1, 0, 0]}]\n"
      "time: {step: 0.01, end: 0.1}\noutput: {}\n");
  CHECK(has(flies, "+0 % from start to end\n"));
  CHECK_FALSE(has(flies, "  lost "));
}

TEST_CASE("summary: after --resume updates and wall time are those of the run and of the session") {
  const Scratch folder;
  folder.write("s.yaml", narrow_tank("0.2", "0.5") + "checkpoint: {every: 1000}\n");
  const Outcome first = run_scene(folder, "a");
  REQUIRE(first.code == 0);
  CHECK(has(first.out, "updates             100 (0.5 s simulated)\nwall time "));
  CHECK_FALSE(has(first.out, "session"));
  const Outcome second = run_scene(folder, "a", {"--resume", "--set", "time.end=0.7"});
  REQUIRE(second.code == 0);
  CHECK(has(second.out,
            "updates             140 (0.7 s simulated), 40 of them in this session, which went on "
            "from update 100\n"));
  CHECK(has(second.out, " in this session, "));
  CHECK(has(second.out, " in all 2 sessions\n"));
}

TEST_CASE("a summary tells how many particles each run has") {
  const Scratch folder;
  folder.write("tiny.yaml", tiny_scene());
  REQUIRE(pbf::test::pbf({"batch", "tiny.yaml", "--grid", "fluid.spacing=0.1,0.2", "--out", "o",
                          "--set", "time.end=0.01", "--quiet"},
                         folder.path())
              .code == 0);
  std::istringstream lines(read_text(folder / "o/summary.csv"));
  std::string units, head, many, few;
  std::getline(lines, units), std::getline(lines, head), std::getline(lines, many),
      std::getline(lines, few);
  CHECK(head.ends_with(",particles,frames,warnings,seconds"));
  CHECK(has(many, ",64,2,"));
  CHECK(has(few, ",8,2,"));
}
