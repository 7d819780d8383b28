// A step that is too long for fluid to see the fluid that it meets is told.
#include <cmath>

#include "lib/run/step_control.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;

namespace {

/// Two cubes of 6^3 particles that meet head on, each at `speed` (m/s) in the frame that moves at
/// `drift`; h = 0.04 m.
Case cubes(double speed, double step, double drift = 0) {
  Case c = here(jittered_block(12, 6, 6, 0, 0));
  c.scene.gravity = {0, 0, 0};
  c.scene.time.step = step;
  for (std::size_t a = 0; a < 3; ++a) {
    c.scene.domain.min[a] -= 1;
    c.scene.domain.max[a] += 1;
  }
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const bool right = i % 12 >= 6;
    if (right) c.particles.position[i][0] += 0.02;
    c.particles.velocity[i] = {drift + (right ? -speed : speed), 0, 0};
  }
  return c;
}

/// Mean velocity of the left cube along x, over `speed`.
double kept(pbf::Solver& solver, double speed) {
  const auto s = solver.download({"velocity"}, pbf::ScalarType::f64).get();
  const auto v = s.find("velocity")->as<double>();
  double sum = 0;
  for (std::size_t i = 0; i < s.count; ++i) sum += i % 12 < 6 ? v[3 * i] : 0;
  return sum / (double(s.count) / 2 * speed);
}

}  // namespace

TEST_CASE("cubes that meet by 2 h a step pass through each other, which is counted and measured") {
  Case c = cubes(10, 0.004);
  c.scene.time.order = pbf::TimeOrder::first;
  auto solver = make(c);
  solver->step(6);
  CHECK(kept(*solver, 10) > 0.7);
  const pbf::Diagnostics m = solver->diagnose();
  CHECK(m.unresolved > 100);
  CHECK(m.relative_way_max > 1.9);
}

TEST_CASE("cubes that meet by 0.2 h a step bounce, and nothing is counted") {
  const Case c = cubes(10, 0.0004);
  auto solver = make(c);
  solver->step(40);
  CHECK(kept(*solver, 10) < 0.2);
  CHECK(solver->diagnose().unresolved == 0);
  CHECK(solver->diagnose().relative_way_max == 0);
}

TEST_CASE("fluid that moves fast as a whole is resolved") {
  auto solver = make(cubes(0, 0.004, 50));
  solver->step(3);
  CHECK(solver->diagnose().unresolved == 0);
}

TEST_CASE("the count is part of the state") {
  const Case c = cubes(10, 0.004);
  auto a = make(c), b = make(c);
  a->step(6);
  b->set_state(a->state());
  CHECK(b->diagnose().unresolved == a->diagnose().unresolved);
  CHECK(b->diagnose().relative_way_max == a->diagnose().relative_way_max);
}

TEST_CASE("an adaptive step is halved while neighbors move too far past each other") {
  Case c = here(cubes(0, 0.004));
  c.scene.time.adaptive = pbf::AdaptiveTime{};
  pbf::AdaptiveStep step(c.scene);
  pbf::Diagnostics m;
  m.speed_max = 0.1;
  CHECK_FALSE(step.follow(m));
  m.unresolved = 5;
  m.time = 0.04, m.update = 10;
  CHECK(step.follow(m));
  CHECK(step.level() == 1);
  m.unresolved = 9;
  m.time = 0.08, m.update = 20;
  CHECK(step.follow(m));
  CHECK(step.level() == 2);
}
