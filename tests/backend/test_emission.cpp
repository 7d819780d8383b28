// Emitters and sinks in runs: numbers, ids, speeds, and that all kinds of steps agree about them,
// on every backend and precision.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "lib/exec/make_solver.h"
#include "lib/program/plan.h"
#include "lib/run/emit.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::emission_test {
namespace {

using scene_test::parse;

struct Emitted {
  Scene scene;
  Plan plan;
  Emitted(const std::string& text, const std::vector<std::string>& set, int threads = 1) {
    scene = parse(text, set);
    scene.threads = threads;
    scene.backend = backend_test::backend();
    scene.precision = backend_test::precision();
    plan = make_plan(scene, std::int64_t(particles().size()));
  }
  Particles particles() const { return emit_particles(scene, ""); }
  std::unique_ptr<Solver> solver() const { return make_solver(scene, plan, particles()); }
  /// The numbers of the columns of an emitter or a sink.
  std::vector<double> read(Solver& s, const std::string& kind) const {
    const std::vector<double> all = s.readings(Series::measures, Interval::goes_on);
    std::vector<double> out;
    for_each_number(plan.columns, Series::measures,
                    [&](const ReadingColumn& c, int, std::size_t k) {
                      if (c.kind == kind) out.push_back(all.at(k));
                    });
    return out;
  }
};

const std::string kJet =
    "domain: {min: [0, 0, 0], max: [1.2, 0.6, 0.6], open: [x_max]}\n"
    "fluid: {spacing: 0.04}\n"
    "bodies: [{shape: block, min: [1.0, 0, 0], max: [1.12, 0.12, 0.12]}]\n"
    "gravity: 0\n"
    "time: {step: 0.004, end: 0.5}\n"
    "emitters:\n"
    "  - {name: jet, shape: disc, center: [0.2, 0.3, 0.3], normal: [1, 0, 0], radius: 0.11, speed: "
    "2}\n";
/// Two emitters of different speeds into a pool with a drain.
const std::string kPool =
    "domain: {min: [0, 0, 0], max: [0.8, 0.6, 0.8]}\n"
    "fluid: {spacing: 0.05}\n"
    "bodies: [{shape: block, min: [0, 0, 0], max: [0.8, 0.6, 0.3]}]\n"
    "time: {step: 0.003, end: 1}\n"
    "emitters:\n"
    "  - {name: a, shape: disc, center: [0.4, 0.3, 0.6], normal: [0, 0, -1], radius: 0.09, speed: "
    "1.5, start: 0.03}\n"
    "  - {name: b, shape: rectangle, center: [0.25, 0.3, 0.15], normal: [1, 0, 0], size: [0.2, "
    "0.1], speed: 0.9, end: 0.2}\n"
    "sinks: [{name: drain, min: [0.7, 0, 0], max: [0.8, 0.6, 0.08]}]\n";

/// 1 + the layers that have come by t, each half a spacing farther back than the one before.
std::int64_t layers(double way, double spacing) {
  return std::int64_t(std::floor(way / spacing + 0.5 + 1e-7));
}
std::int64_t born_in_pool(double t) {
  return 5 * layers(1.5 * std::max(t - 0.03, 0.0), 0.05) + 8 * layers(0.9 * std::min(t, 0.2), 0.05);
}

struct Kind {
  std::vector<std::string> set;
  int level = 0;
};
const std::vector<Kind> kKinds = {
    {{}},
    {{"time.order=1"}},
    {{}, 2},
    {{"time.order=1"}, 1},
    {{"solver.substeps=3"}},
    {{"solver.substeps=3", "time.order=1"}, 1},
    {{"time.order=1", "solver.iterations=1"}, 3},
    {{"solver.tolerance=1e-4", "solver.fused=false"}},
    {{"solver.kernels=paper"}},
    {{"viscosity.xsph=0.1", "vorticity.epsilon=0.5", "solver.velocity_damping=0.99"}},
    {{"domain.loads=true",
      R"(obstacles=[{"name":"post","shape":"box","min":[0.6,0.1,0],"max":[0.65,0.5,0.4],)"
      R"("loads":true}])"}},
    {{"solver.iterations=0", "viscosity.xsph=0.1"}},
    {{"solver.reproducible=true"}}};

bool same(const SolverState& a, const SolverState& b) {
  bool fields = a.fields.size() == b.fields.size();
  // Particles add to one of several sums of the dissipation by their rows, which a state forgets.
  for (std::size_t k = 0; fields && k < a.fields.size(); ++k)
    fields = a.fields[k].name == "dissipation" || a.fields[k] == b.fields[k];
  return a.id == b.id && a.position == b.position && a.velocity == b.velocity && fields;
}

}  // namespace

TEST_CASE(
    "emission: a pool that is filled and drained counts what comes and goes, update by update") {
  const Emitted e(kPool, {});
  const auto solver = e.solver();
  for (int update = 3; update <= 30; update += 3) {
    solver->step(3);
    const SolverState s = solver->state();
    CAPTURE(update);
    const std::vector<double> gone = e.read(*solver, "sink");
    const std::int64_t all = e.plan.particles + born_in_pool(0.003 * update);
    REQUIRE(gone[0] > 0);
    REQUIRE(std::int64_t(s.id.size()) == all - std::int64_t(gone[0]));
    REQUIRE(std::adjacent_find(s.id.begin(), s.id.end(), std::greater_equal<>()) == s.id.end());
    REQUIRE(s.id.back() == all - 1);
  }
}

TEST_CASE("emission: a sink books mass, momentum and energy of what it takes") {
  // Half of a block that flies without gravity, and that a nozzle does not reach.
  const Emitted e(
      "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
      "fluid: {spacing: 0.05}\n"
      "bodies: [{shape: block, min: [0.6, 0.6, 0.6], max: [0.9, 0.9, 0.9], velocity: [1, 0.5, "
      "-0.25]}]\n"
      "gravity: 0\n"
      "time: {step: 0.002, end: 1}\n"
      "emitters: [{name: jet, shape: disc, center: [0.3, 0.3, 0.3], normal: [1, 0, 0], radius: "
      "0.1, speed: 0.5}]\n"
      "sinks: [{name: drain, min: [0.6, 0.6, 0.6], max: [0.75, 0.9, 0.9]}]\n",
      {});
  const auto solver = e.solver();
  solver->step(1);
  const std::vector<double> s = e.read(*solver, "sink");
  const double mass = 108 * e.plan.mass;
  CHECK(s[0] == 108);
  CHECK(s[1] == Approx(mass));
  CHECK(s[2] == Approx(mass).epsilon(1e-5));
  CHECK(s[3] == Approx(0.5 * mass).epsilon(1e-5));
  CHECK(s[4] == Approx(-0.25 * mass).epsilon(1e-5));
  CHECK(s[5] == Approx(0.5 * 1.3125 * mass).epsilon(1e-5));
  CHECK(std::int64_t(solver->state().id.size()) == e.plan.particles - 108);
}

TEST_CASE("emission: what waits in a pipe under water stays in its place, and so does the water") {
  const Emitted e(
      "domain: {min: [0, 0, 0], max: [0.8, 0.6, 0.8]}\n"
      "fluid: {spacing: 0.05}\n"
      "bodies: [{shape: block, min: [0, 0, 0], max: [0.8, 0.6, 0.4]}]\n"
      "time: {step: 0.003, end: 1}\n"
      "emitters: [{name: jet, shape: disc, center: [0.3, 0.3, 0.2], normal: [1, 0, 0], radius: "
      "0.08, speed: 0}]\n",
      {});
  const auto solver = e.solver();
  const SolverState before = solver->state();
  solver->step(8);
  const SolverState after = solver->state();
  REQUIRE(after.id == before.id);
  const std::int64_t columns = e.plan.emission.nozzles[0].columns;
  std::int64_t held = 0;
  for (std::size_t k = 0; k < after.id.size(); ++k) {
    double way = 0;  // h
    for (std::size_t a = 0; a < 3; ++a)
      way = std::max(way, std::fabs(after.position[3 * k + a] - before.position[3 * k + a]));
    CAPTURE(after.id[k]);
    REQUIRE(way < 0.25);
    if (after.id[k] < e.plan.emission.first_id) continue;
    ++held;
    CHECK(way < 1e-6);
  }
  CHECK(held == columns * e.plan.emission.layers);
}

TEST_CASE("emission: the energy that a jet brings under gravity is that of its particles") {
  std::string text = kJet;
  text.erase(text.find("gravity: 0\n"), 11);
  const Emitted e(text, {"bodies=[]"});
  const auto solver = e.solver();
  const auto energy = [&](const Diagnostics& m) { return m.kinetic_energy + m.potential_energy; };
  const double start = energy(solver->diagnose());
  solver->step(50);
  const Diagnostics m = solver->diagnose();
  CHECK(m.inflow > 0);
  CHECK(energy(m) - start == Approx(m.inflow).epsilon(0.01));
}

TEST_CASE("emission: every kind of step has the particles of the formula, each with its own id",
          "[slow]") {
  for (const Kind& kind : kKinds) {
    const Emitted e(kPool, kind.set);
    const std::int64_t start = e.plan.particles;
    REQUIRE(start == e.plan.emission.first_id + 2 * (5 + 8));
    const auto solver = e.solver();
    for (int update = 10; update <= 100; update += 10) {
      solver->step(10, {.level = kind.level});
      const SolverState s = solver->state();
      CAPTURE(kind.set, kind.level, update);
      const std::int64_t born = born_in_pool(0.003 * update);
      const std::vector<double> gone = e.read(*solver, "sink");
      REQUIRE(std::int64_t(s.id.size()) == start + born - std::int64_t(gone[0]));
      REQUIRE(std::adjacent_find(s.id.begin(), s.id.end(), std::greater_equal<>()) == s.id.end());
      REQUIRE(s.id.back() == start + born - 1);
      REQUIRE(solver->diagnose().non_finite == 0);
    }
    const std::vector<double> emitted = e.read(*solver, "emitter");
    CHECK(emitted[0] == double(5 * layers(1.5 * 0.27, 0.05)));
    CHECK(emitted[3] == double(8 * layers(0.9 * 0.2, 0.05)));
    CHECK(emitted[1] == Approx(emitted[0] * e.plan.mass));
  }
}

TEST_CASE("emission: a run that resumes, or goes back, has the same bits", "[slow]") {
  for (const Kind& kind : kKinds) {
    const Emitted e(kPool, kind.set);
    const auto one = e.solver(), two = e.solver();
    CAPTURE(kind.set, kind.level);
    const StepOptions options{.level = kind.level};
    one->step(23, options);
    one->keep();
    const SolverState middle = one->state();
    one->step(31, options);
    const SolverState end = one->state();
    two->set_state(middle);
    CHECK(same(two->state(), middle));
    for (const int n : {1, 13, 17}) two->step(n, options);
    CHECK(same(two->state(), end));
    one->set_state(one->state(StateOf::kept));
    one->step(31, options);
    CHECK(same(one->state(), end));
  }
}

TEST_CASE("emission: the bits do not depend on threads or on measurements between", "[slow]") {
  const Emitted one(kPool, {"solver.substeps=2"}), three(kPool, {"solver.substeps=2"}, 3);
  const auto a = one.solver(), b = three.solver();
  a->step(80);
  for (int k = 0; k < 40; ++k) {
    b->step(2);
    b->diagnose();
    b->download({"density"}, ScalarType::f32).get();
  }
  CHECK(same(a->state(), b->state()));
}

TEST_CASE("emission: a free jet is not compressed and keeps its speed", "[slow]") {
  for (const std::vector<std::string>& set : std::vector<std::vector<std::string>>{
           {},
           {"time.order=1"},
           {"time.step=0.012"},
           {"solver.substeps=3"},
           {"emitters.0.normal=[1, 0.4, -0.3]", "emitters.0.center=[0.2, 0.4, 0.6]",
            "domain.max=[1.2, 1, 1]"},
           {"fluid.smoothing_ratio=3", "domain.max=[1.6, 1, 1]",
            "emitters.0.center=[0.4, 0.5, 0.5]"}}) {
    const Emitted e(kJet, set);
    const auto solver = e.solver();
    const Double3 along = e.plan.emission.nozzles[0].place.normal;
    CAPTURE(set);
    for (double t = 0; t < 0.3;) {
      solver->step(int(std::round(0.024 / e.scene.time.step)));
      t = double(solver->updates()) * e.scene.time.step;
      const Diagnostics m = solver->diagnose();
      REQUIRE(m.compression_max < 1e-4);
      const SolverState s = solver->state();
      for (std::size_t k = 0; k < s.id.size(); ++k) {
        if (s.id[k] < e.plan.emission.first_id) continue;
        double speed = 0, all = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          const double v = e.scene.h() * s.velocity[3 * k + a];
          speed += v * along[a], all += v * v;
        }
        REQUIRE(speed == Approx(2).epsilon(1e-3));
        REQUIRE(all - speed * speed < 1e-5);  // sideways
      }
      // The energy that came in is that of the particles.
      CHECK(m.kinetic_energy - m.inflow ==
            Approx(2.0 * e.plan.mass * double(e.plan.emission.nozzles[0].columns) *
                   e.plan.emission.layers)
                .epsilon(1e-3));
    }
  }
}

TEST_CASE("emission: layers in the pipe keep their places whatever presses on them", "[slow]") {
  const Emitted e(kPool, {"emitters.1.speed=0", "gravity=[0, 0, -60]"});
  const auto solver = e.solver();
  const SolverState before = solver->state();
  solver->step(60);
  const SolverState after = solver->state();
  const std::int64_t first = e.plan.emission.id(1, 0);
  int held = 0;
  for (std::size_t k = 0; k < after.id.size(); ++k) {
    if (after.id[k] < first || after.id[k] >= first + 16) continue;
    ++held;
    const auto was = std::size_t(std::ranges::find(before.id, after.id[k]) - before.id.begin());
    for (std::size_t a = 0; a < 3; ++a) {
      CHECK(after.position[3 * k + a] == Approx(before.position[3 * was + a]).epsilon(1e-6));
      CHECK(after.velocity[3 * k + a] == 0);
    }
  }
  CHECK(held == 16);
  // Nobody else is in the pipe.
  const NozzlePlace& pipe = e.plan.emission.nozzles[1].place;
  for (std::size_t k = 0; k < after.id.size(); ++k) {
    if (after.id[k] >= e.plan.emission.first_id) continue;
    const Double3 x{0.1 * after.position[3 * k], 0.1 * after.position[3 * k + 1],
                    0.1 * after.position[3 * k + 2]};
    CHECK(!pipe.holds(x, -1e-6));
  }
}

TEST_CASE("emission: one sink takes what comes in, with its mass, momentum and energy", "[slow]") {
  // The jet flies into the sink as it is.
  Emitted e(kJet + "sinks: [{name: end, min: [0.9, 0, 0.13], max: [1.2, 0.6, 0.6]}]\n", {});
  const auto solver = e.solver();
  const std::int64_t start = e.plan.particles;
  solver->step(125);
  const std::vector<double> s = e.read(*solver, "sink");
  const auto n = std::int64_t(s[0]);
  CHECK(n > 100);
  CHECK(std::int64_t(solver->state().id.size()) + n == start + 21 * layers(2 * 0.5, 0.04));
  CHECK(s[1] == Approx(double(n) * e.plan.mass));
  CHECK(s[2] == Approx(s[1] * 2).epsilon(1e-4));
  CHECK(s[3] == Approx(0).margin(1e-3 * s[2]));
  CHECK(s[5] == Approx(s[1] * 2).epsilon(1e-4));  // V^2/2 = V for V = 2
  const Diagnostics m = solver->diagnose();
  CHECK(m.particles == std::int64_t(solver->state().id.size()));
}

TEST_CASE("emission: more particles than the capacity stop the run, with emitter and time") {
  const std::int64_t most = Emitted(kPool, {"sinks=[]"}).plan.particles + 30;
  const Emitted e(kPool, {"sinks=[]", "capacity=" + std::to_string(most)});
  const auto solver = e.solver();
  std::string text;
  try {
    for (int k = 0; k < 100; ++k) solver->step(3);
    solver->diagnose();
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::guard);
    text = error.what();
  }
  CHECK(scene_test::contains(text, "s emitters["));
  CHECK(scene_test::contains(text, "had no room for a layer of"));
  CHECK(scene_test::contains(text, "there is memory for " + std::to_string(most) + " at a time"));
}

}  // namespace pbf::emission_test
