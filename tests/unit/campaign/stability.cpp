// Suite files, criteria, maps and the guard's limits.
#include "lib/campaign/stability.h"

#include <cmath>
#include <limits>

#include "lib/campaign/stability_map.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

const std::string kCase = "cases:\n  - {name: a, group: g, scene: s.yaml, must: {speed: 3}}\n";

std::string suite_error(const std::string& text) {
  const Folder folder;
  folder.write("s.yaml", kMinimal);
  const std::string path = folder.write("suite.yaml", text);
  return error_of([&] { read_stability_suite(path); });
}

StabilityRow run_one(const std::string& must, const std::string& set = "time.end: 0.1") {
  const Folder folder;
  folder.write("s.yaml", kMinimal);
  const auto cases = read_stability_suite(
      folder.write("suite.yaml", "cases:\n  - {name: a, group: g, scene: s.yaml, set: {" + set +
                                     "}, must: {" + must + "}}\n"));
  StabilityOptions o;
  o.threads = 1;
  return run_stability_case(cases.at(0), o).value();
}

}  // namespace

TEST_CASE(
    "stability suite: the shipped one has at least 30 cases, in both sizes valid scenes or "
    "refused ones") {
  const auto cases = read_stability_suite(PBF_SOURCE_DIR "/configs/stability.yaml");
  CHECK(cases.size() >= 30);
  for (const StabilityCase& c : cases) {
    CAPTURE(c.name);
    CHECK(std::filesystem::exists(c.scene));
    CHECK((c.must.error || c.must.speed || c.must.guard.size() || c.must.compression_mean));
  }
}

TEST_CASE("stability suite: whatever is wrong in the file is told with its place", "[slow]") {
  CHECK(suite_error(kCase) == "no error");
  CHECK(contains(suite_error("cases:\n  - {name: a, group: g, scene: s.yaml, must: {sped: 3}}\n"),
                 "suite.yaml:2:47: sped: unknown key, did you mean speed?"));
  CHECK(contains(suite_error("cases:\n  - {name: a, group: g, must: {}}\n"),
                 "suite.yaml:2:5: scene: missing; required"));
  CHECK(contains(suite_error("cases:\n  - {name: a, group: g, scene: s, must: {speed: fast}}\n"),
                 "\"fast\" is not a number"));
  CHECK(contains(suite_error("cases:\n  - {name: a, group: g, scene: s, must: {guard: luck}}\n"),
                 "\"luck\" is no alarm of the guard"));
  CHECK(contains(suite_error(kCase + "  - {name: a, group: g, scene: s, must: {like: b}}\n"),
                 "a is given twice"));
  CHECK(contains(suite_error(kCase + "  - {name: b, group: g, scene: s, must: {like: c}}\n"),
                 "there is no case c"));
  CHECK(contains(suite_error("cases: []\n"), "missing; required"));
  CHECK(contains(suite_error("casse: []\n"), "did you mean cases?"));
}

TEST_CASE("stability case: a criterion that is not met fails the case, and says by how much",
          "[slow]") {
  const StabilityRow good = run_one("speed: 100, nearest: 0.5");
  CHECK(good.good);
  CHECK(good.used > 0);
  CHECK(good.used < 1);
  const StabilityRow slow = run_one("speed: 0.001");
  CHECK_FALSE(slow.good);
  CHECK(slow.used > 1);
  CHECK(slow.tightest == "speed");
  CHECK(contains(slow.happened, "(!)"));
  CHECK_FALSE(run_one("nearest: 1.5").good);
  CHECK_FALSE(run_one("guard: speed").good);  // it ran to its end
  CHECK_FALSE(run_one("error: 2").good);
}

TEST_CASE(
    "stability case: an error or a stop by the guard counts where it must happen, and only "
    "then",
    "[slow]") {
  CHECK(run_one("error: 2, says: time.step", "time.step: .nan").good);
  CHECK_FALSE(run_one("error: 2, says: gravity", "time.step: .nan").good);
  CHECK_FALSE(run_one("error: 3", "time.step: .nan").good);
  CHECK_FALSE(run_one("speed: 100", "time.step: .nan").good);
  const std::string fast = "guard: {speed: 1.0e-6}, measure_every: 1";
  CHECK(run_one("guard: speed", fast).good);
  CHECK(run_one("guard: allowed", fast).good);
  CHECK_FALSE(run_one("guard: energy", fast).good);
  CHECK_FALSE(run_one("speed: 100", fast).good);
}

TEST_CASE("stability case: how deep in obstacles, what goes through, and what loads add up to",
          "[slow]") {
  const std::string box = "{name: a, shape: box, min: [0.4, -1, -1], max: [0.6, 2, 2]}";
  const std::string set = "time.end: 0.1, obstacles: [" + box + "]";
  const StabilityRow good = run_one("penetration: 0.0001, loads: 0.0001", set);
  CHECK(good.good);
  REQUIRE(good.checks.size() == 4);
  CHECK(good.checks[3].name == "loads");
  CHECK(good.checks[3].value > 0);  // they were booked, and rounding is left
  // 300 particles are below a level rectangle, and gravity points up.
  const std::string flow =
      "time.end: 0.3, gravity: [0, 0, 10], gauges: [{name: Q, kind: flow, center: [0.5, 0.5, 0.3], "
      "normal: [0, 0, 1], size: [1, 1]}]";
  const StabilityRow through = run_one("through: 0", flow);
  CHECK_FALSE(through.good);
  CHECK(through.checks.back().value > 50);
  CHECK(run_one("through: 300", flow).good);
  // A solid that comes to fill the box: nowhere to go, and no deeper than the box is wide.
  const std::string press =
      "time.end: 1, guard: off, obstacles: [{name: a, shape: box, min: [-1, -1, 1], "
      "max: [2, 2, 4], motion: {kind: velocity, velocity: [0, 0, -1.5]}}]";
  const StabilityRow pressed = run_one("penetration: 0.0001", press);
  CHECK_FALSE(pressed.good);
  CHECK(pressed.checks.back().value > 1);
  CHECK(pressed.checks.back().value < 9);  // h: the diagonal of the box is 8.7
}

TEST_CASE("stability case: a warning of the scene counts where it must come") {
  const std::string far =
      "time.end: 0.1, obstacles: [{name: far, shape: sphere, center: [5, 5, 5], "
      "radius: 0.1}]";
  CHECK(run_one("warns: (far) lies outside the domain", far).good);
  CHECK_FALSE(run_one("warns: (near) lies outside the domain", far).good);
}

TEST_CASE("stability case: files of motions lie beside the scene") {
  const Folder folder;
  folder.write("s.yaml", kMinimal);
  folder.write("m.csv", "t,x,y,z\n0,0,0,0\n2,0.1,0,0\n");
  const auto cases = read_stability_suite(folder.write(
      "suite.yaml",
      "cases:\n  - {name: a, group: g, scene: s.yaml, must: {speed: 100}, set: {time.end: 0.1, "
      "obstacles: [{name: a, shape: sphere, center: [0.5, 0.5, 0.9], radius: 0.2, motion: {kind: "
      "file, path: m.csv}}]}}\n"));
  StabilityOptions o;
  o.threads = 1;
  const StabilityRow row = run_stability_case(cases.at(0), o).value();
  CAPTURE(row.happened);
  CHECK(row.good);
}

TEST_CASE("stability case: likeness compares centres of mass in h") {
  StabilityCase a, b;
  a.name = std::string("a");
  b.name = std::string("b");
  b.must.like = a.name;
  std::vector<StabilityRow> rows(2);
  rows[0].name = std::string("a");
  rows[1].name = std::string("b");
  rows[1].good = true;
  rows[1].center = {0.09, 0, 0};
  judge_likeness({a, b}, rows);
  CHECK(rows[1].good);
  rows[1].center = {0.11, 0, 0};
  judge_likeness({a, b}, rows);
  CHECK_FALSE(rows[1].good);
}

TEST_CASE("nearest distance: as brute force finds it") {
  std::vector<double> x;
  for (int i = 0; i < 300; ++i) x.push_back(std::fmod(i * i * 0.7548776662, 1));
  double best = 10;
  for (std::size_t i = 0; i < 100; ++i)
    for (std::size_t j = 0; j < i; ++j)
      best = std::min(best, std::hypot(x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1],
                                       x[3 * i + 2] - x[3 * j + 2]));
  CHECK(nearest_distance(x) == best);
  CHECK(nearest_distance({1, 2, 3}) == std::numeric_limits<double>::infinity());
  CHECK(nearest_distance({1, 2, 3, 1, 2, 3}) == 0);
}

TEST_CASE(
    "stability map: values from lists and ranges, the scene's own by default, and wrong ones are "
    "refused") {
  const Folder folder;
  const std::string s = folder.write("s.yaml", kMinimal);
  const auto values = [&](const std::string& key, const std::string& text) {
    return map_values(s, {}, key, text);
  };
  CHECK(values("time.step", "0.1,0.2") == std::vector<double>{0.1, 0.2});
  const auto range = values("gravity", "1:100:3");
  REQUIRE(range.size() == 3);
  CHECK(range[1] == Approx(10));
  CHECK(values("time.step", "") == std::vector<double>{0.0025, 0.005, 0.01, 0.02, 0.04, 0.08});
  CHECK(values("gravity", "")[2] == 9.81);
  for (const char* text : {"1:2", "2:1:3", "1:2:1", "a,b", "1,,2", ".nan"})
    CHECK(contains(error_of([&] { values("time.step", text); }), "2 values of time.step"));
  CHECK(contains(error_of([&] {
                   values("name", "1");
                   values("name", "");
                 }),
                 "is not a number"));
  CHECK(contains(error_of([&] { values("time.stp", ""); }), "is no key"));
}

TEST_CASE("stability map: gravity is scaled along its own direction, and time with it") {
  const Folder folder;
  StabilityMap m;
  m.scene = folder.write("s.yaml", kMinimal + "gravity: [0, -3, -4]\n");
  m.x_key = "time.step";
  m.y_key = "gravity";
  m.x = {0.002};
  m.y = {20};
  m.iterations = {4};
  m.run.threads = 1;
  m.run.overrides = {"time.end=0.1"};
  const auto cells = map_cells(m);
  REQUIRE(cells.size() == 1);
  const MapCell c = run_map_cell(m, cells[0]).value();
  CHECK(c.dt_hat == Approx(0.002 * std::sqrt(20 / 0.2)));
  CHECK(c.verdict == MapClass::stable);
  m.limit = 0;
  CHECK(run_map_cell(m, cells[0])->verdict == MapClass::degraded);
  m.run.overrides.push_back("guard.speed=0.0001");
  CHECK(run_map_cell(m, cells[0])->stopped_for == "speed");
}

}  // namespace pbf::scene_test
