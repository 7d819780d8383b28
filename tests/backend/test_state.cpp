// A state taken out of a solver and put into another, and an update with every pass on view.
#include <algorithm>
#include <cmath>

#include "lib/base/error.h"
#include "lib/run/guard.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;

namespace {

Case everything() {
  Case c = here(jittered_block(14, 12, 13, 0.3, 0.4));
  c.scene.domain.max[0] += 0.1;
  c.scene.tensile = pbf::Tensile{};
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.vorticity = pbf::Vorticity{};
  c.scene.time.order = GENERATE(pbf::TimeOrder::first, pbf::TimeOrder::second);
  return c;
}

bool same_bytes(pbf::Solver& a, pbf::Solver& b) {
  const auto x = a.download({"velocity"}, pbf::ScalarType::f64).get();
  const auto y = b.download({"velocity"}, pbf::ScalarType::f64).get();
  for (std::size_t f = 0; f < x.fields.size(); ++f)
    if (x.fields[f].bytes != y.fields[f].bytes) return false;
  return x.update == y.update;
}

bool same(const pbf::SolverState& a, const pbf::SolverState& b) {
  return a.precision == b.precision && a.updates == b.updates && backend_test::same_particles(a, b);
}

const pbf::TraceArray& last(const pbf::StepTrace& t, const char* quantity) {
  const pbf::TraceArray* found = nullptr;
  for (const auto& a : t.arrays)
    if (a.quantity == quantity) found = &a;
  REQUIRE(found);
  return *found;
}

}  // namespace

TEST_CASE("a state put into a fresh solver continues to the last bit", "[slow]") {
  const Case c = everything();
  auto a = make(c);
  a->step(13);
  const pbf::SolverState s = a->state();
  CHECK(s.precision == c.scene.precision);
  auto b = make(c);
  SECTION("at once") { b->set_state(s); }
  SECTION("measured and downloaded in between") {
    b->set_state(s);
    CHECK(b->diagnose().kinetic_energy == Approx(a->diagnose().kinetic_energy));
    b->download({"density"}, pbf::ScalarType::f32).get();
    CHECK(same(b->state(), s));
  }
  SECTION("into a solver that has run elsewhere") {
    b->step(70);
    b->set_state(s);
  }
  SECTION("twice") {
    b->set_state(s);
    b->step(3);
    b->set_state(s);
  }
  CHECK(b->updates() == 13);
  for (const int k : {1, 20, 70}) {
    a->step(k);
    b->step(k);
    CHECK(same_bytes(*a, *b));
  }
  CHECK(same(a->state(), b->state()));
}

TEST_CASE("an update by trace() gives the bytes of step(1), before, between and after others",
          "[slow]") {
  Case c = everything();
  SECTION("as it is") {}
  SECTION("substeps, which step(1) joins in one pass") {
    c.scene.solver.substeps = 3;
    c.scene.solver.iterations = 2;
    c.scene.solver.speed_limit = 0.02;
  }
  SECTION("no pairs, which step(1) does not look for") {
    c.scene.solver.iterations = 0;
    c.scene.tensile.reset(), c.scene.viscosity.reset(), c.scene.vorticity.reset();
  }
  auto a = make(c), b = make(c);
  for (const int k : {1, 4, 66}) {
    a->step(k + 1);
    b->inspection()->trace();
    b->step(k);
    CHECK(same_bytes(*a, *b));
  }
}

TEST_CASE("how often a run is measured does not change its bytes", "[slow]") {
  Case c = everything();
  SECTION("as it is") {}
  SECTION("substeps, after which a measure makes its own lists") {
    c.scene.solver.substeps = 3;
    c.scene.solver.iterations = 2;
  }
  auto a = make(c), b = make(c);
  for (const int k : {1, 2, 5, 70, 3}) {
    a->step(k);
    b->step(k);
    b->diagnose();
    b->keep();
    CHECK(same(a->state(), b->state(pbf::StateOf::kept)));
    b->download({"density"}, pbf::ScalarType::f32).get();
  }
  b->diagnose();
  CHECK(same_bytes(*a, *b));
}

TEST_CASE("a trace ends with the state of the solver and lists the stages in order") {
  Case c = everything();
  c.scene.solver.iterations = 2;
  SECTION("fused") {}
  SECTION("unfused") { c.scene.solver.fused = false; }
  auto s = make(c);
  s->step(5);
  const pbf::StepTrace t = s->inspection()->trace();
  std::vector<std::string> stages;
  for (const auto& a : t.arrays)
    if (stages.empty() || stages.back() != a.stage) stages.push_back(a.stage);
  CHECK(stages == std::vector<std::string>{"predict", "grid", "density", "lambda", "delta",
                                           "density", "lambda", "delta", "xsph", "vorticity"});
  const auto snap = s->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto v = snap.find("velocity")->as<double>();
  const auto& traced = last(t, "velocity").values;
  double worst = 0;
  for (std::size_t k = 0; k < v.size(); ++k)
    worst = std::max(worst, std::fabs(v[k] - c.scene.h() * traced[k]));
  CHECK(worst < 1e-14);
}

TEST_CASE("the traced neighbors are the pairs closer than h, by brute force") {
  const Case c = here(jittered_block(7, 8, 6, 0.4, 0.2));
  auto s = make(c);
  const pbf::StepTrace t = s->inspection()->trace();
  const auto& x = t.arrays[0].values;  // predicted positions, h
  REQUIRE(t.arrays[0].quantity == "position");
  const std::size_t n = c.particles.size();
  REQUIRE(t.neighbor_begin.size() == n + 1);
  std::size_t unclear = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const double d =
          std::hypot(x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1], x[3 * i + 2] - x[3 * j + 2]);
      const bool listed = std::binary_search(t.neighbors.begin() + t.neighbor_begin[i],
                                             t.neighbors.begin() + t.neighbor_begin[i + 1], int(j));
      if (std::fabs(d - 1) < 1e-5)
        ++unclear;
      else if (listed != (d < 1))
        FAIL("pair " << i << " " << j << " at " << d);
    }
  CHECK(unclear < 20);
}

TEST_CASE("random roundings are of the size asked for and come again with their seed") {
  const Case c = everything();
  auto s = make(c);
  s->step(3);
  const pbf::SolverState start = s->state();
  const auto traced = [&](pbf::TraceOptions r) {
    s->set_state(start);
    return s->inspection()->trace(r);
  };
  const double u = 1e-5;
  const auto plain = traced({}), one = traced({u, 1, nullptr}), again = traced({u, 1, nullptr}),
             two = traced({u, 2, nullptr});
  CHECK(last(one, "velocity").values == last(again, "velocity").values);
  CHECK(last(one, "velocity").values != last(two, "velocity").values);
  double worst = 0;  // of the first array, which nothing amplifies
  for (std::size_t k = 0; k < plain.arrays[0].values.size(); ++k)
    worst = std::max(worst, std::fabs(one.arrays[0].values[k] / plain.arrays[0].values[k] - 1));
  CHECK(worst < 1.02 * u);
  CHECK(worst > 0.9 * u);
}

TEST_CASE("a state of another number of particles, or with ids that are not 0..n-1, is refused") {
  const Case c = here(jittered_block(4, 4, 4, 0.3, 0));
  auto s = make(c);
  pbf::SolverState state = s->state();
  SECTION("fewer") { state.id.pop_back(); }
  SECTION("twice the same id") { state.id[0] = state.id[1]; }
  SECTION("an id too large") { state.id[0] = 64; }
  SECTION("a negative id") { state.id[0] = -1; }
  SECTION("positions missing") { state.position.pop_back(); }
  CHECK_THROWS_AS(s->set_state(state), pbf::Error);
}

TEST_CASE("coincident particles part by their ids, whatever the order of rows") {
  const bool flat = GENERATE(false, true);
  Case c = here(flat ? flat_block(30, 20, 0.3, 0.4) : jittered_block(11, 9, 10, 0.3, 0.4));
  // One iteration, for which the others see the same positions in the same order.
  c.scene.solver.iterations = 1;
  const auto put_on = [&](std::size_t i, std::size_t j) {
    c.particles.position[i] = c.particles.position[j];
    c.particles.velocity[i] = c.particles.velocity[j];
  };
  for (std::size_t i = 100; i < 200; i += 10) put_on(i, i + 50 + i / 50);  // in twos, ...
  put_on(17, 401), put_on(18, 401);                                        // ... and three
  auto a = make(c), b = make(c);
  const pbf::SolverState s = a->state();
  pbf::SolverState turned = s;  // those of each place in the opposite order
  const auto same_place = [&](std::size_t k, std::size_t m) {
    return std::equal(s.position.begin() + 3 * std::ptrdiff_t(k),
                      s.position.begin() + 3 * std::ptrdiff_t(k) + 3,
                      s.position.begin() + 3 * std::ptrdiff_t(m));
  };
  std::size_t moved = 0;
  for (std::size_t k = 0; k < s.id.size(); ++k) {
    std::vector<std::size_t> rows;
    for (std::size_t m = 0; m < s.id.size(); ++m)
      if (same_place(k, m)) rows.push_back(m);
    const auto at = std::size_t(std::find(rows.begin(), rows.end(), k) - rows.begin());
    turned.id[k] = s.id[rows[rows.size() - 1 - at]];
    if (turned.id[k] != s.id[k]) ++moved;
  }
  REQUIRE(moved >= 20);
  a->set_state(s);
  b->set_state(turned);
  CHECK(same_bytes(*a, *b));
  a->step(1);
  b->step(1);
  CHECK(same_bytes(*a, *b));
}

TEST_CASE("what the guard keeps of a state makes the same next step in a run of its own") {
  Case c = here(jittered_block(8, 7, 6, 0.2, 0.3));
  c.scene.domain.max[0] += 0.2;
  c.scene.time.order = GENERATE(pbf::TimeOrder::first, pbf::TimeOrder::second);
  if (GENERATE(false, true)) {
    c.scene.tank_motion = pbf::TankMotion{};
    c.scene.tank_motion->axis = pbf::Double3{1, 2, 0.5};
    c.scene.tank_motion->amplitude = 30;
    c.scene.tank_motion->period = 0.4;
  }
  CAPTURE(int(c.scene.time.order), c.scene.tank_motion.has_value());
  auto whole = make(c);
  whole->step(23);
  Case again = c;
  again.particles = pbf::to_particles(whole->state(), c.scene);
  again.scene.time.motion_begin += 23 * c.scene.time.step;
  auto alone = make(again);
  const double before = alone->diagnose().speed_max;
  whole->step(1), alone->step(1);
  const auto x = whole->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto y = alone->download({"velocity"}, pbf::ScalarType::f64).get();
  double farthest = 0, fastest = 0;
  for (std::size_t k = 0; k < 3 * x.count; ++k) {
    farthest =
        std::max(farthest, std::abs(x.fields[0].as<double>()[k] - y.fields[0].as<double>()[k]));
    fastest = std::max(fastest, std::abs(x.find("velocity")->as<double>()[k] -
                                         y.find("velocity")->as<double>()[k]));
  }
  CHECK(before > 0.1);
  CHECK(farthest < (is_double() ? 1e-12 : 1e-5) * c.scene.h());
  CHECK(fastest < (is_double() ? 1e-9 : 1e-2) * c.scene.h());
}
