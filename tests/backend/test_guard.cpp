// The guard on every backend and precision: faults put in by hand, stage by stage.
#include <cmath>
#include <limits>

#include "lib/run/guard.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"
#include "tests/support/guard_check.h"

using namespace oracle_test;
using backend_test::here;

namespace {

Case all_stages() {
  Case c = here(jittered_block(6, 6, 6, 0.2, 0));
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.vorticity = pbf::Vorticity{};
  c.scene.tensile = pbf::Tensile{};
  c.scene.solver.fused = false;  // gives the density a stage of its own
  return c;
}

pbf::Plan plan_of(const Case& c) {
  return pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
}

/// What the guard finds in `updates` updates with the fault in one of them.
std::optional<pbf::GuardEvent> caught(const Case& c, const pbf::Fault& fault, int updates) {
  auto solver = make(c);
  const pbf::Diagnostics first = solver->diagnose();
  pbf::Guard guard(c.scene, plan_of(c), *solver, first, first);
  solver->inspection()->inject(fault);
  solver->step(updates, guard.options());
  return check(guard, solver->diagnose());
}

bool same_state(const pbf::SolverState& a, const pbf::SolverState& b) {
  return a.position == b.position && a.velocity == b.velocity && a.id == b.id &&
         a.updates == b.updates;
}

}  // namespace

TEST_CASE(
    "guard: a NaN, an infinity and a huge velocity put into any stage are caught by the next "
    "measure, which names update, stage, iteration and particle") {
  const Case c = all_stages();
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  for (const char* stage :
       {"predict", "grid", "neighbors", "density", "lambda", "delta", "xsph", "vorticity"}) {
    const std::string name = stage;
    const int iteration = name == "density" || name == "lambda" || name == "delta" ? 3 : 0;
    for (const double value : {nan, infinity, 1e6})
      for (const int update : {2, 5}) {  // in the middle of the interval, and its last
        CAPTURE(stage, value, update);
        const auto e = caught(c, {update, stage, iteration, 40, value}, 5);
        REQUIRE(e);
        REQUIRE(e->stage);
        CHECK(e->stage->stage == name);
        CHECK(e->stage->iteration == iteration);
        CHECK(e->stage->update == update);
        CHECK(e->stage->id == 40);
        CHECK(e->alarm == (std::isfinite(value) ? pbf::Alarm::speed : pbf::Alarm::non_finite));
        CHECK(e->last_good.updates == 0);
      }
  }
}

TEST_CASE(
    "guard: a run without a fault raises no alarm, and looking at every stage changes no bit") {
  const Case c = all_stages();
  auto guarded = make(c), looked_at = make(c), bare = make(c);
  const pbf::Diagnostics first = guarded->diagnose();
  pbf::Guard guard(c.scene, plan_of(c), *guarded, first, first);
  for (int k = 0; k < 4; ++k) {
    guarded->step(5, guard.options());
    REQUIRE_FALSE(check(guard, guarded->diagnose()));
    for (int u = 0; u < 5; ++u) REQUIRE_FALSE(looked_at->inspection()->step_checked({}));
  }
  bare->step(20);
  CHECK(same_state(guarded->state(), bare->state()));
  CHECK(same_state(looked_at->state(), bare->state()));
}

TEST_CASE("guard: from the kept state the same updates give the same bits") {
  const Case c = all_stages();
  auto s = make(c);
  s->step(7);
  s->keep();
  const pbf::SolverState kept = s->state(pbf::StateOf::kept);
  CHECK(same_state(kept, s->state()));
  s->step(6);
  const pbf::SolverState first = s->state();
  s->set_state(kept);
  s->diagnose();  // between two updates a measure may look
  s->step(6);
  CHECK(same_state(first, s->state()));
}

TEST_CASE("guard: energy that grows without a source, and too many neighbors, name a particle") {
  Case c = here(jittered_block(6, 6, 6, 0.2, 0));
  SECTION("energy: artificial pressure a thousand times too strong") {
    c.scene.tensile = pbf::Tensile{10, 0.3, 4};
    const auto e = caught(c, {}, 5);
    REQUIRE(e);
    CHECK(e->alarm == pbf::Alarm::energy);
    REQUIRE(e->stage);
    CHECK(e->stage->stage == "delta");
    CHECK(e->stage->update == 1);
    CHECK(e->value > e->limit);
  }
  SECTION("neighbors: more than the scene allows") {
    c.scene.guard->neighbors = 20;
    const auto e = caught(c, {}, 1);
    REQUIRE(e);
    CHECK(e->alarm == pbf::Alarm::neighbors);
    REQUIRE(e->stage);
    CHECK(e->stage->stage == "neighbors");
    CHECK(e->value > 20);
  }
}

TEST_CASE("speed limit: slows down the particles above it, counts them, and no other run changes") {
  Case c = here(jittered_block(4, 4, 4, 0, 0));
  c.scene.gravity = {0, 0, 0};
  c.scene.domain.max = {10, 10, 10};
  c.particles.position.push_back({5, 5, 5});
  c.particles.velocity.push_back({-30, 40, 0});  // 0.1 m in an update, h = 0.04 m
  const auto place = [](pbf::Solver& s) {
    const auto snap = s.download({"velocity"}, pbf::ScalarType::f64).get();
    const auto x = snap.fields[0].as<double>();
    return std::vector<double>(x.end() - 3, x.end());
  };
  auto free = make(c);
  free->step(3);
  CHECK(free->diagnose().fast == 0);
  CHECK(place(*free)[1] == Approx(5.24).epsilon(1e-5));
  c.scene.solver.speed_limit = 0.5;  // h in an update: 10 m/s
  auto limited = make(c);
  limited->step(3);
  CHECK(limited->diagnose().fast == 1);  // once: after that it is slow
  CHECK(place(*limited)[0] == Approx(5 - 3 * 0.002 * 6).epsilon(1e-5));
  CHECK(place(*limited)[1] == Approx(5 + 3 * 0.002 * 8).epsilon(1e-5));
  CHECK(limited->diagnose().speed_max == Approx(10).epsilon(1e-5));
}
