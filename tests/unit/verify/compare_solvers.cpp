// pbf compare on two solvers: what is the same passes, what is not is found in its stage.
#include "lib/base/error.h"
#include "lib/exec/make_solver.h"
#include "lib/program/plan.h"
#include "lib/run/emit.h"
#include "lib/scene/load.h"
#include "lib/solver/solver.h"
#include "lib/verify/compare.h"
#include "tests/support/catch.h"

using namespace pbf;

namespace {

Scene scene(const std::vector<std::string>& overrides = {}) {
  return load_scene(std::string(PBF_SOURCE_DIR) + "/tests/regression/defects/scene.yaml", overrides)
      .scene;
}

CompareSettings settings(const char* a, const char* b) {
  CompareSettings s;
  s.a = parse_side(a);
  s.b = parse_side(b);
  s.warmup = 10;
  s.updates = 10;
  s.members = 3;
  return s;
}

CompareResult compare(const Scene& a, const Scene& b, const CompareSettings& s) {
  return compare_between(a, b, ".", s, nullptr);
}

}  // namespace

TEST_CASE("sides are read as they are written, and wrong ones are refused by name", "[compare]") {
  for (const char* text : {"cpu:double", "cpu:float@2", "cuda:float"})
    CHECK(parse_side(text).name() == text);
  for (const char* text : {"", "cpu", "gpu:float", "cpu:half", "cpu:float@", "cpu:float@0",
                           "cpu:float@x", "cuda:float@2", "cpu@2:float"}) {
    CAPTURE(text);
    try {
      parse_side(text);
      FAIL("accepted");
    } catch (const Error& e) {
      CHECK(e.code() == ExitCode::bad_input);
      CHECK(std::string(e.what()).find("e.g. cpu:double") != std::string::npos);
    }
  }
}

// A search that leaves these cells out would go unseen otherwise.
TEST_CASE("in the scene of the seeded defects particles are in the grid's last half cells",
          "[compare]") {
  const Particles particles = emit_particles(scene(), ".");
  const Plan plan = make_plan(scene(), std::int64_t(particles.size()));
  const auto solver = make_solver(scene(), plan, particles);
  solver->step(50);
  const SolverState s = solver->state();
  int there = 0;
  for (std::size_t k = 0; k < s.id.size(); ++k)
    there += 2 * s.position[3 * k + std::size_t(plan.axes.of[0])] > plan.cells[0] - 1;
  CHECK(there > 10);
}

TEST_CASE("threads change no bit, and compare asks for that", "[compare]") {
  const CompareResult r = compare(scene(), scene(), settings("cpu:float@1", "cpu:float@2"));
  CHECK(r.same());
  REQUIRE(r.parts.size() == 3);
  for (const ComparePart& p : r.parts) {
    CHECK(p.rows.size() > 0);
    for (const CompareRow& row : p.rows) {
      CAPTURE(p.name, row.what);
      CHECK(row.error == 0);
      CHECK(row.tolerance == 0);
    }
  }
}

TEST_CASE("float is within the tolerance of double, and not by a wide margin", "[compare]") {
  const CompareResult r = compare(scene(), scene(), settings("cpu:double", "cpu:float"));
  CHECK(r.same());
  CHECK(r.stage.empty());
  double largest = 0;
  for (const CompareRow& row : r.parts[0].rows)
    if (row.error > 0) largest = std::max(largest, row.error / row.tolerance);
  CHECK(largest > 0.02);  // a tolerance a hundred times too wide would find nothing
  CHECK(r.parts[0].rows.size() > 20);
  REQUIRE(r.diagrams.size() == 1);
  CHECK(r.diagrams[0].curves.at(0).y.size() == 10);
}

// In a box of 100 h float's positions are off by up to 4e-6 h, and so is each density. The lambda
// that the same pass makes of it is small, for the fluid is hardly compressed.
TEST_CASE("an error that lambda inherits from the density of its own pass is not lambda's",
          "[compare]") {
  const Scene s =
      load_scene(std::string(PBF_SOURCE_DIR) + "/configs/dam_break_2d.yaml", {"threads=1"}).scene;
  CompareSettings of = settings("cpu:double", "cpu:float");
  of.warmup = 20;
  of.updates = 1;
  of.members = 8;
  const CompareResult r = compare(s, s, of);
  CHECK(r.stage.empty());
  int lambdas = 0;
  for (const CompareRow& row : r.parts[0].rows) {
    if (row.what.find("lambda") == std::string::npos) continue;
    CAPTURE(row.what, row.error, row.tolerance);
    ++lambdas;
    CHECK(row.error > 0);
    CHECK(row.error < row.tolerance / 4);
  }
  CHECK(lambdas == s.solver.iterations);
  // And no error of its own is lost: a tenth of a per cent of the denominator shows.
  Scene other = s;
  other.solver.cfm += 1e-3;
  CHECK(compare(s, other, of).stage == "lambda");
}

// At the start of a dam break all particles are slow, and float rounds the way of each substep.
TEST_CASE("roundings that go one way do so in every substep, and are no difference",
          "[slow][compare]") {
  const Scene s = load_scene(std::string(PBF_SOURCE_DIR) + "/configs/dam_break_2d.yaml",
                             {"threads=1", "solver.substeps=6"})
                      .scene;
  CompareSettings of = settings("cpu:double", "cpu:float");
  of.warmup = 40;
  of.updates = 20;
  of.members = 8;
  of.seed = 25;
  const CompareResult r = compare(s, s, of);
  CHECK(r.same());
}

TEST_CASE("a key that differs on purpose is found in the stage that it belongs to", "[compare]") {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"gravity=[0,0,-9.83]", "predict"},
      {"solver.velocity_damping=0.998", "predict"},
      {"solver.cfm=0.012", "lambda"},
      {"tensile.k=0.0055", "delta"},
      {"solver.sor=0.99", "delta"},
      {"viscosity.xsph=0.101", "xsph"},
      {"vorticity.epsilon=0.55", "vorticity"},
      {"solver.iterations=4", "iterations"},
      {"solver.boundary=clamp", "density"},
      {"viscosity=off", "xsph"},
      {"solver.kernels=paper", "density"}};
  const auto [key, stage] = cases[std::size_t(GENERATE(range(0, 11)))];
  CAPTURE(key);
  CompareSettings s = settings("cpu:double", "cpu:float");
  s.warmup = 5;
  s.updates = 1;
  s.members = 3;
  // Of a given step length, so that another one changes nothing else, and a confinement that its
  // bound does not cut.
  const std::string length = "solver.sor=1", curl = "vorticity.epsilon=0.5";
  const CompareResult r = compare(scene({length, curl}), scene({length, curl, key}), s);
  CHECK_FALSE(r.same());
  CHECK(r.stage == stage);
}

TEST_CASE("two doubles of different arithmetic promise nothing, yet a key of 1e-9 shows",
          "[compare]") {
  // The same solver as "other" arithmetic is out of reach here; the tolerance of double is not.
  CompareSettings s = settings("cpu:double", "cpu:double");
  s.updates = 2;
  const CompareResult r = compare(scene(), scene({"gravity=[0,0,-9.81000001]"}), s);
  CHECK_FALSE(r.same());
  CHECK(r.stage == "predict");
}

TEST_CASE("a difference that shows only later is traced in the update where it begins",
          "[slow][compare]") {
  // The far wall is elsewhere on B, in the same cell: nobody is near it at first.
  CompareSettings s = settings("cpu:double", "cpu:float");
  s.warmup = 0;
  s.updates = 40;
  const CompareResult r = compare(scene({"domain.max=[0.431,0.25,0.24]", "threads=1"}),
                                  scene({"domain.max=[0.439,0.25,0.24]", "threads=1"}), s);
  REQUIRE(r.parts.size() >= 4);
  CHECK(r.parts[0].verdict == Verdict::same);
  CHECK(r.parts[2].verdict == Verdict::differs);
  CHECK(r.parts.back().name.rfind("frozen step at update ", 0) == 0);
  CHECK(r.parts.back().verdict == Verdict::differs);
  CHECK(r.stage == "density");  // the wall's share of it
}

TEST_CASE("reports hold every part", "[compare]") {
  CompareResult r;
  r.a = "cpu:double <1>";
  r.b = "cpu:float";
  r.notes = {"a & b"};
  r.stage = "lambda";
  ComparePart p{"frozen step", Verdict::differs, "found", "why", {}};
  p.rows.push_back({"lambda 1: lambda", "h^2", 2, 1, 0.5, 7, 1, Verdict::differs});
  r.parts.push_back(p);
  r.diagrams.push_back({"title", "update", "h", {{"one", {1, 2, 3}, {1e-7, 0, 1e-3}}}});
  CHECK_FALSE(r.same());
  const std::string text = compare_text(r), data = compare_json(r);
  CHECK(text.find("DIFFERENT, first in stage `lambda`") != std::string::npos);
  CHECK(text.find("tolerance: why") != std::string::npos);
  CHECK(data.find("\"stage\": \"lambda\"") != std::string::npos);
  CHECK(data.find("\"tolerance\": 1.0,") != std::string::npos);
  CHECK(data.find("\"horizon_updates\": null") != std::string::npos);
  CHECK(data.find("\"diagram\": \"title\"") != std::string::npos);
}
