// Obstacles in whole updates against brute force, on every backend and precision.

#include "tests/support/catch.h"
#include "tests/support/obstacles.h"

using namespace oracle_test;
using namespace obstacle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::same_bytes;
using backend_test::Series;
using pbf_test::ObstacleShape;

namespace {

constexpr double kRound = 1.0;  // h, the least radius

/// A block with every shape in it, turned and not, one against two walls; some particles are fast.
Case all_shapes() {
  Case c = jittered_block(14, 10, 12, 0.2, 0.4);
  Placing put(c.scene);
  put.plane({7.4, 2.5, 0.4}, {-0.8, 0.1, 0.5});
  put.box({0.6, 0.6, 0.6}, {1.8, 1.6, 2}, {1, 2, -1}, 50);
  put.sphere({4.2, 3.6, 1.5}, kRound);
  put.tube(ObstacleShape::capsule, {1.5, 3.5, 4}, {2.3, 3.9, 4.7}, kRound);
  put.tube(ObstacleShape::cylinder, {5.1, 1.2, 4.2}, {5.9, 1.4, 4.9}, kRound);
  put.box({3.4, -0.2, 0}, {4.6, 1, 0.8});
  for (std::size_t i = 0; i < c.particles.size(); i += 3)
    for (double& v : c.particles.velocity[i]) v *= 25;
  return without_inner(here(c), 1e-3);
}
Case all_flat_shapes() {
  Case c = flat_block(26, 24, 0.2, 0.4);
  Placing put(c.scene);
  put.plane({13, 0, 1}, {-0.8, 0, 0.5});
  put.box({1.5, 0, 1.4}, {2.9, 0, 3.2}, {0, 2, 0}, 35);
  put.sphere({6.5, 0, 2.5}, 1.3);
  put.tube(ObstacleShape::capsule, {3, 0, 8}, {4.5, 0, 9.5}, kRound);
  pbf::obstacle_keys::Tube& o =
      pbf_test::tube_of(put.tube(ObstacleShape::cylinder, {9, 0, 8.5}, {9, 0, 8.5}, 1.2));
  o.from[1] -= 0.01, o.to[1] += 0.01;
  put.box({8, 0, 0}, {9.2, 0, 1.1});
  for (std::size_t i = 0; i < c.particles.size(); i += 3)
    for (double& v : c.particles.velocity[i]) v *= 25;
  return without_inner(here(c), 1e-3);
}

void check_by_force(const Case& c) {
  const Difference d = against_oracle(c);
  // The oracle's gradients are differences over 1e-7 h. At the surface itself the second derivative
  // of the fit for two dimensions jumps, in space the third one.
  const double exact = c.scene.dimensions == 2 ? 1e-7 : 1e-8;
  CHECK(d.position < (is_double() ? exact : 1e-4));
  CHECK(d.velocity < (is_double() ? 3 * exact : 2e-4));
}

}  // namespace

TEST_CASE("one update among obstacles of every shape equals the brute-force oracle", "[slow]") {
  Case c = GENERATE(false, true) ? all_flat_shapes() : all_shapes();
  SECTION("defaults") {
    // Many are in reach of an obstacle, and many meet one.
    auto s = make(c);
    s->step(1);
    const auto solids = oracle_solids(c.scene);
    const pbf::Snapshot snap = places_of(*s);
    const auto x = snap.fields[0].as<double>();
    int near = 0, meet = 0;
    for (std::size_t i = 0; i < snap.count; ++i) {
      double there[3];
      for (std::size_t k = 0; k < 3; ++k)
        there[k] = c.particles.position[i][k] + c.scene.time.step * c.particles.velocity[i][k];
      const double depth = depth_in(solids, c.scene, &x[3 * i]);
      near += depth > -0.7;
      meet += depth_in(solids, c.scene, there) > 0;
      CHECK(depth < fine());
    }
    CHECK(near > 120);
    CHECK(meet > (c.scene.dimensions == 2 ? 3 : 12));
  }
  SECTION("first order") { c.scene.time.order = pbf::TimeOrder::first; }
  SECTION("the paper's kernels") { c.scene.solver.kernels = pbf::KernelMode::paper; }
  SECTION("substeps, viscosity, tensile, vorticity") {
    c.scene.solver.substeps = 3;
    c.scene.solver.iterations = 1;
    c.scene.viscosity = pbf::Viscosity{0.1};
    c.scene.tensile = pbf::Tensile{0.002, 0.3, 4};
    c.scene.vorticity = pbf::Vorticity{5};
  }
  SECTION("bare surfaces, unfused") {
    c.scene.solver.boundary = pbf::BoundaryMode::clamp;
    c.scene.solver.fused = false;
  }
  check_by_force(c);
}

TEST_CASE("one update among obstacles in a box with any longest edge is that of brute force",
          "[slow]") {
  const std::size_t longest = GENERATE(0u, 1u, 2u);
  Case c = jittered_block(7, 8, 9, 0.2, 0.4);
  for (std::size_t k = 0; k < 3; ++k)
    c.scene.domain.max[k] = c.scene.domain.min[k] + 0.04 * (5.1 + (k == longest ? 3.3 : double(k)));
  c.scene.gravity = {1, 2, -3};
  c.scene.gravity[longest] = 9;
  Placing put(c.scene);
  put.box({0.6, 0.7, 0.8}, {1.7, 1.5, 2.1}, {3, 1, 2}, -65);
  put.tube(ObstacleShape::capsule, {2.4, 2.9, 1.8}, {2.6, 3.5, 2.8}, kRound);
  put.plane({0.3, 0.2, 3.9}, {0.6, 0.3, -0.5});
  check_by_force(without_inner(here(c), 1e-3));
}

TEST_CASE("obstacles far from the origin of coordinates give the same bits as near it") {
  Case c = jittered_block(8, 7, 9, 0.2, 0.4);
  c.scene.fluid.spacing = 0.015625;
  c.scene.domain = {{0, 0, 0}, {0.1875, 0.125, 0.25}, {}, true};
  for (std::size_t i = 0; i < c.particles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      double& x = c.particles.position[i][k];
      x = std::round((x - std::array{-0.1, 0.3, -2.0}[k]) * 0.78125 * 0x1p20) * 0x1p-20;
    }
  Placing put(c.scene);
  put.box({0.5, 0.75, 0.5}, {1.5, 1.5, 1.5}, {1, 2, 3}, 40);
  put.sphere({3.25, 2, 1.5}, 1);
  put.tube(ObstacleShape::cylinder, {1, 2.5, 3.5}, {1.5, 2.75, 4}, 1);
  put.plane({5.5, 2, 0.5}, {-1, 0.25, 0.5});
  c = without_inner(here(c), 0.1);
  Case far = c;
  const auto move = [](pbf::Double3& x) {
    const pbf::Double3 by{131072, -65536, 100000};
    for (std::size_t k = 0; k < 3; ++k) x[k] += by[k];
  };
  move(far.scene.domain.min), move(far.scene.domain.max);
  for (auto& x : far.particles.position) move(x);
  for (pbf::Obstacle& o : far.scene.obstacles)
    for (pbf::Double3* x : pbf_test::places_in(o)) move(*x);
  auto a = make(c), b = make(far);
  a->step(20);
  b->step(20);
  const pbf::SolverState near_state = a->state(), far_state = b->state();
  CHECK(near_state.position == far_state.position);
  CHECK(near_state.velocity == far_state.velocity);
  CHECK(*near_state.find("loads") == *far_state.find("loads"));
}

TEST_CASE("updates among obstacles have the same bits on 1 and 2 threads, and pass by pass",
          "[slow]") {
  Case c = GENERATE(false, true) ? all_flat_shapes() : all_shapes();
  c.scene.domain.loads = true;
  if (c.scene.dimensions == 3) REQUIRE(c.particles.size() > 1024);
  if (GENERATE(false, true)) c.scene.solver.substeps = 2;
  c.scene.solver.hyperviscosity = 0;  // no readings but loads
  auto a = make(c);
  a->step(12);
  const pbf::Snapshot first = a->download({"velocity", "density"}, pbf::ScalarType::f64).get();
  const auto loads = a->readings(Series::measures, pbf::Interval::goes_on);
  REQUIRE(loads.size() == 10 * (c.scene.dimensions == 3 ? 12u : 10u));
  const auto same = [&](pbf::Solver& s) {
    CHECK(same_bytes(first, s.download({"velocity", "density"}, pbf::ScalarType::f64).get()));
    backend_test::check_loads(s, loads);
  };
  SECTION("threads") {
    c.scene.threads = 1;
    auto b = make(c);
    b->step(12);
    same(*b);
  }
  SECTION("pass by pass") {
    auto b = make(c);
    b->step(8);
    for (int k = 0; k < 4; ++k) b->inspection()->trace();
    same(*b);
  }
}

TEST_CASE("what slides down a tilted face without fluid around it is not braked") {
  const bool box = GENERATE(false, true), bare = GENERATE(false, true);
  Case c = here(jittered_block(1, 1, 1, 0, 0));
  c.scene.domain = {{0, 0, 0}, {1, 1, 1}, {}, false};
  c.scene.solver.boundary = pbf::BoundaryMode::clamp;
  c.scene.solver.iterations = bare ? 0 : 4;
  const double angle = 0.5, n[2] = {std::sin(angle), std::cos(angle)};
  Placing put(c.scene);
  if (box)  // a turned cube of 10 h whose upper face goes through the same place
    put.box({9 - 5 * n[0], 5, 9 - 5 * n[1]}, {9 - 5 * n[0], 5, 9 - 5 * n[1]}, {0, 1, 0},
            angle * 180 / std::acos(-1.0));
  else
    put.plane({9, 9, 9}, {n[0], 0, n[1]});
  for (std::size_t k = 0; box && k < 3; ++k) {
    pbf_test::box_of(c.scene.obstacles[0]).min[k] -= 5 * c.scene.h();
    pbf_test::box_of(c.scene.obstacles[0]).max[k] += 5 * c.scene.h();
  }
  c.particles.position = {put.at({9 + 1e-3 * n[0], 9, 9 + 1e-3 * n[1]})};
  c.particles.velocity = {{0, 0, 0}};
  auto s = make(c);
  const int steps = 100;
  s->step(steps);
  const pbf::Snapshot snap = s->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto v = snap.find("velocity")->as<double>();
  const pbf::Diagnostics m = s->diagnose();
  const double speed = (m.time - m.velocity_lag) * 9.81 * n[0];
  CHECK(v[0] == Approx(speed * n[1]).epsilon(1e-3));
  CHECK(v[2] == Approx(-speed * n[0]).epsilon(1e-3));
}
