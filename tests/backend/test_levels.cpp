// Levels (solver.levels) against brute force over all nodes, on every backend and precision.
#include "tests/support/catch.h"
#include "tests/support/obstacles.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::same_bytes;

namespace {

/// The block in a box of this many spacings, with levels.
Case in_box(Case c, pbf::Double3 spacings) {
  for (std::size_t k = 0; k < 3; ++k)
    c.scene.domain.max[k] = c.scene.domain.min[k] + c.scene.fluid.spacing * spacings[k];
  c.scene.solver.levels = pbf::LevelsMode::on;
  return here(c);
}
/// Boxes that are no multiple of 2 h, full of fluid that is compressed by a few percent.
Case column(double squeeze = 0.985) {
  return in_box(jittered_block(6, 5, 26, 0.1, 0.4, 1, squeeze), {6.4, 5.2, 26.6});
}
Case flat_column() { return in_box(flat_block(11, 40, 0.1, 0.4, 1, 0.985), {11.4, 1, 40.6}); }

/// h, the farthest that levels alone take a particle in an update.
double reach_of_levels(Case c) {
  auto a = make(c);
  c.scene.solver.levels = pbf::LevelsMode::off;
  auto b = make(c);
  a->step(1);
  b->step(1);
  const auto x = a->download({}, pbf::ScalarType::f64).get(),
             y = b->download({}, pbf::ScalarType::f64).get();
  double most = 0;
  const auto p = x.fields[0].as<double>(), q = y.fields[0].as<double>();
  for (std::size_t k = 0; k < p.size(); ++k)
    most = std::max(most, std::fabs(p[k] - q[k]) / c.scene.h());
  return most;
}

/// Sums at nodes count C in steps of 1e-9.
oracle::LevelNodes check_against_oracle(const Case& c) {
  const Difference d = against_oracle(c);
  REQUIRE(d.nodes.closest > 0.01);  // no rounding decides which nodes are on
  REQUIRE(d.nodes.touch > 1e-3);
  CHECK(d.position < (is_double() ? 1e-8 : 2e-5));
  CHECK(d.velocity < (is_double() ? 2e-8 : 4e-5));
  return d.nodes;
}

}  // namespace

TEST_CASE("one update with levels equals the brute-force oracle, feature by feature", "[slow]") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_column() : column();
  SECTION("defaults") { CHECK(against_oracle(c).nodes.off == 0); }
  SECTION("one iteration") { c.scene.solver.iterations = 1; }
  SECTION("unfused, walls that only clamp") {
    c.scene.solver.fused = false;
    c.scene.solver.boundary = pbf::BoundaryMode::clamp;
    c.scene.fluid.mass = 0.0095;  // else less than rho0 within h of walls, so nearly everywhere
  }
  SECTION("the paper's kernels, a fixed omega") {
    c.scene.solver.kernels = pbf::KernelMode::paper;
    c.scene.solver.sor = 0.6;
  }
  SECTION("h = 1.6 d") { c.scene.fluid.smoothing_ratio = 1.6; }
  SECTION("h = 3 d") {
    if (!flat) c = column(0.95);
    c.scene.fluid.smoothing_ratio = 3;
  }
  SECTION("a given mass") { c.scene.fluid.mass = 0.0085; }
  SECTION("three substeps, damped") {
    c.scene.solver.substeps = 3;
    c.scene.solver.velocity_damping = 0.9;
    REQUIRE(pbf::make_plan(c.scene, 100).lists_per_update == 1);
  }
  SECTION("all in all three substeps, two iterations, tensile, viscosity") {
    c.scene.solver.substeps = 3;
    c.scene.solver.iterations = 2;
    c.scene.tensile = pbf::Tensile{0.002, 0.3, 4};
    c.scene.viscosity = pbf::Viscosity{0.1};
  }
  check_against_oracle(c);
  CHECK(reach_of_levels(c) > 1e-3);
}

TEST_CASE("levels with gravity and the long edge along x equal the brute-force oracle", "[slow]") {
  Case c = in_box(jittered_block(26, 6, 5, 0.1, 0.4, 1, 0.985), {26.6, 6.4, 5.2});
  c.scene.gravity = {-9.81, 0, 0};
  check_against_oracle(c);
  CHECK(reach_of_levels(c) > 1e-3);
}

TEST_CASE("nodes beside air and open faces are off, as in the brute-force oracle", "[slow]") {
  SECTION("a box half empty") {
    const Case c = in_box(jittered_block(6, 5, 13, 0.1, 0.4, 1, 0.985), {6.4, 5.2, 26.6});
    const auto nodes = check_against_oracle(c);
    CHECK(nodes.on > 0);
    CHECK(nodes.off > nodes.on);
    CHECK(reach_of_levels(c) > 1e-3);
  }
  SECTION("a box half empty, in two dimensions") {
    const Case c = in_box(flat_block(11, 21, 0.1, 0.4, 1, 0.985), {11.4, 1, 40.6});
    CHECK(check_against_oracle(c).off > 0);
    CHECK(reach_of_levels(c) > 1e-3);
  }
  SECTION("open faces, and particles that leave through them") {
    Case c = in_box(jittered_block(10, 5, 26, 0.1, 0.4, 1, 0.985), {10.8, 5.2, 26.6});
    c.scene.domain.open = {"x_max", "z_max"};
    for (std::size_t i = 9; i < c.particles.size(); i += 50) c.particles.velocity[i] = {60, 0, 0};
    const auto nodes = check_against_oracle(c);
    CHECK(nodes.on > 0);
    CHECK(nodes.off > 0);
    CHECK(reach_of_levels(c) > 1e-3);
  }
  SECTION("nothing but air: no correction") {
    const Case c = in_box(jittered_block(6, 5, 1, 0.1, 0.4), {20.8, 20.8, 26.6});
    CHECK(check_against_oracle(c).on == 0);
    CHECK(reach_of_levels(c) == 0);
  }
}

TEST_CASE("nodes whose hats an obstacle reaches are off, as in the brute-force oracle", "[slow]") {
  Case c = GENERATE(false, true) ? flat_column() : column();
  obstacle_test::Placing put(c.scene);
  SECTION("a turned box") { put.box({1, 0.5, 9.1}, {2, 1.5, 10.4}, {0, 1, 0}, 30); }
  SECTION("a plate of 0.2 h") { put.box({-1, -1, 8.3}, {9, 9, 8.5}); }
  SECTION("a ball") { put.sphere({1.2, 1.1, 4.9}, 1); }
  SECTION("the floor, a plane") { put.plane({0, 0, 0.55}, {0.1, 0, 1}); }
  c = obstacle_test::without_inner(c, 1e-3);
  const auto nodes = check_against_oracle(c);
  CHECK(nodes.reached > 0);
  CHECK(nodes.on > 0);
  CHECK(nodes.off > 0);
  CHECK(reach_of_levels(c) > 1e-3);
}

TEST_CASE("levels move fluid that no wall holds as the brute-force oracle does", "[slow]") {
  SECTION("a block in the middle of a box, not on the grid") {
    Case c = in_box(jittered_block(20, 18, 22, 0.1, 0.4, 1, 0.97), {60.5, 55, 50});
    c.scene.fluid.smoothing_ratio = 2.1;  // half a cell is no whole number
    for (auto& x : c.particles.position)
      for (std::size_t k = 0; k < 3; ++k) x[k] += c.scene.fluid.spacing * (14.7 + 0.6 * double(k));
    const auto nodes = check_against_oracle(c);
    CHECK(nodes.on > 0);
    CHECK(nodes.free > 0);
    CHECK(reach_of_levels(c) > 1e-3);
  }
  SECTION("a block on the floor, far from the sides") {
    Case c = in_box(jittered_block(20, 18, 22, 0.1, 0.4, 1, 0.97), {60.5, 55, 50});
    c.scene.fluid.smoothing_ratio = 2.1;  // half a cell is no whole number
    for (auto& x : c.particles.position)
      for (std::size_t k = 0; k < 2; ++k) x[k] += c.scene.fluid.spacing * 16.3;
    check_against_oracle(c);
    CHECK(reach_of_levels(c) > 1e-3);
  }
}

TEST_CASE("levels keep the momentum of fluid that no wall holds, to rounding") {
  Case c = in_box(jittered_block(30, 18, 22, 0.1, 0.4, 1, 0.96), {70, 60, 60});
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    auto& x = c.particles.position[i];
    const bool left = x[0] - c.scene.domain.min[0] < 15 * c.scene.fluid.spacing;
    for (std::size_t k = 0; k < 3; ++k) x[k] += c.scene.fluid.spacing * (17.3 + 1.7 * double(k));
    c.particles.velocity[i] = {left ? 1.5 : -1.0, left ? 0.3 : 0.0, 0.0};
  }
  c.scene.gravity = {0, 0, 0};
  REQUIRE(reach_of_levels(c) > 1e-3);
  auto solver = make(c);
  const auto before = solver->diagnose();
  solver->step(10);
  const auto after = solver->diagnose();
  REQUIRE(before.compression_mean > 1e-2);
  const double speed = 1, all = speed * c.scene.particle_mass() * double(c.particles.size());
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(std::fabs(after.momentum[k] - before.momentum[k]) < all * (is_double() ? 1e-13 : 1e-6));
}

TEST_CASE(
    "levels count over-dense fluid as compressed by a twentieth, as the brute-force oracle does") {
  Case c = in_box(jittered_block(8, 7, 30, 0.05, 0, 3, 0.985), {8.4, 7.3, 30.6});
  const double d = c.scene.fluid.spacing;
  int dense = 0;
  for (auto& x : c.particles.position) {
    const bool near = std::fabs(x[2] - c.scene.domain.min[2] - 12 * d) < 3 * d;
    dense += near;
    for (std::size_t k = 0; near && k < 3; ++k) {
      const double middle = c.scene.domain.min[k] + d * (k == 2 ? 12 : 4);
      x[k] = middle + 0.8 * (x[k] - middle);  // twice the density
    }
  }
  REQUIRE(dense > 100);
  c.scene.solver.iterations = 1;
  check_against_oracle(c);
  CHECK(reach_of_levels(c) > 1e-3);
}

TEST_CASE("with levels and solver.reproducible the CPU's bytes come out, on 1 thread or more",
          "[slow]") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? in_box(flat_block(150, 150, 0.2, 0.2), {151, 1, 163})
                : in_box(jittered_block(24, 24, 40, 0.2, 0.2), {24.4, 27, 46});
  SECTION("defaults") {}
  SECTION("three substeps, the paper's kernels") {
    c.scene.solver.substeps = 3;
    c.scene.solver.kernels = pbf::KernelMode::paper;
  }
  c.scene.solver.reproducible = true;
  auto a = make(c);
  c.scene.backend = pbf::Backend::cpu;
  c.scene.threads = 1;
  auto b = make(c);
  a->step(8);
  b->step(8);
  CHECK(same_bytes(a->download({"velocity", "density"}, pbf::ScalarType::f64).get(),
                   b->download({"velocity", "density"}, pbf::ScalarType::f64).get()));
}

TEST_CASE("with levels, recorded updates leave what the same updates leave one by one", "[slow]") {
  Case c;
  SECTION("a wide box, nearly empty: most nodes are off") {
    c = in_box(jittered_block(20, 20, 34, 0.2, 0.2, 1, 0.985), {90, 90, 50});
  }
  SECTION("a full box: no node is off") { c = column(); }
  SECTION("air above: all nodes are off") {
    c = in_box(jittered_block(24, 24, 2, 0.2, 0.2), {40, 40, 40});
  }
  SECTION("every particle is near an obstacle") {
    c = in_box(jittered_block(40, 40, 3, 0.1, 0.2), {40.4, 40.4, 30});
    obstacle_test::Placing(c.scene).plane({0, 0, 0.2}, {0, 0, 1});
    c = obstacle_test::without_inner(c, 1e-3);
  }
  c.scene.time.step = 5e-4;
  auto recorded = make(c), alone = make(c);
  const backend_test::Ending a = backend_test::ending_of(*recorded, false, 74),
                             b = backend_test::ending_of(*alone, true, 74);
  REQUIRE(std::isfinite(a.compression));
  backend_test::check_same(a, b);
}
