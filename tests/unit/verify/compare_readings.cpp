// pbf compare on loads and gauges: whole sums of an update, and of the intervals behind it.
#include "lib/scene/load.h"
#include "lib/verify/compare.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

Scene defect_scene(const char* name, std::vector<std::string> overrides = {}) {
  overrides.push_back("threads=1");
  return load_scene(std::string(PBF_SOURCE_DIR) + "/tests/regression/defects/" + name + ".yaml",
                    overrides)
      .scene;
}

CompareResult compare(const Scene& a, const Scene& b, const char* side, int updates = 4) {
  CompareSettings s;
  s.a = parse_side("cpu:double");
  s.b = parse_side(side);
  s.warmup = 50;
  s.updates = updates;
  s.members = 3;
  return compare_between(a, b, ".", s, nullptr);
}

const CompareRow& row(const ComparePart& p, const std::string& what) {
  for (const CompareRow& r : p.rows)
    if (r.what == what) return r;
  FAIL("no row " << what << " in " << p.name);
  return p.rows.front();
}

}  // namespace

TEST_CASE("loads and gauges are compared in the frozen step and behind it, float within tolerance",
          "[slow][compare]") {
  const Scene s = defect_scene("solids");
  const CompareResult r = compare(s, s, "cpu:float");
  CHECK(r.same());
  CHECK(r.notes.size() == 2);  // the scene and its start
  REQUIRE(r.parts.size() == 3);
  for (const std::size_t part : {0, 2}) {
    double largest = 0;
    for (const char* what : {"loads: z_min force_z", "loads: turned force_x", "loads: ball force_y",
                             "loads: blade torque_x", "loads: pipe force_peak", "gauges: H",
                             "gauges: U x", "gauges: P", "gauges: P peak"}) {
      const CompareRow found = row(r.parts[part], what);
      CAPTURE(found.what, found.error, found.tolerance);
      CHECK(found.error > 0);
      CHECK(found.relative < 1e-2);  // it is a number of some size that is compared
      largest = std::max(largest, found.error / found.tolerance);
    }
    CHECK(largest > 0.02);  // a tolerance a hundred times too wide would find nothing
    // One particle more or less is what the sum of whole particles leaves open.
    CHECK_THAT(row(r.parts[part], "gauges: Q total").tolerance,
               Catch::Matchers::WithinRel(0.008, 0.02));
  }
}

TEST_CASE("sides that promise the same bits have the same loads and readings", "[compare]") {
  const char* name = GENERATE("solids", "tank");
  const Scene s = defect_scene(name);
  const CompareResult r = compare(s, s, "cpu:double@2");
  CHECK(r.same());
  for (const std::size_t part : {0, 2})
    for (const CompareRow& one : r.parts[part].rows) {
      CAPTURE(one.what);
      CHECK(one.error == 0);
      CHECK(one.tolerance == 0);
    }
}

TEST_CASE("what moves no particle but changes a load or a reading is found there",
          "[slow][compare]") {
  const std::vector<std::array<const char*, 3>> cases{
      {"solids", "fluid.rest_density=1001", "loads"},
      {"solids", "gauges.0.at=[0.24,0.12]", "gauges"},
      {"solids", "gauges.1.at=[0.26,0.12,0.062]", "gauges"},
      {"solids", "gauges.2.normal=[1,0,0]", "gauges"},
      {"solids", "gauges.3.radius=0.052", "gauges"},
      {"solids", "obstacles.4.motion.angular=[0,801,0]", "predict"},
      {"tank", "tank_motion.amplitude=20.01", "predict"},
      {"tank", "obstacles.0.max=[0.2402,0.24,0.06]", "density"}};
  const auto [name, key, stage] = cases[std::size_t(GENERATE(range(0, 8)))];
  CAPTURE(key);
  const CompareResult r = compare(defect_scene(name), defect_scene(name, {key}), "cpu:float", 1);
  CHECK_FALSE(r.same());
  CHECK(r.stage == stage);
}

TEST_CASE("loads that only one side has are named and not compared", "[compare]") {
  const CompareResult r = compare(defect_scene("solids"),
                                  defect_scene("solids", {"domain.loads=false"}), "cpu:double", 1);
  CHECK(r.same());
  CHECK(r.notes.at(1) ==
        "60 loads and readings of gauges are on one side only and not compared, the first is "
        "loads: x_min force_x of A");
  for (const CompareRow& one : r.parts[0].rows) CHECK(one.what != "loads: x_min force_x");
}
