// One update of the solver against the brute-force oracle, and the solver against itself.
#include <cmath>

#include "tests/support/against_oracle.h"
#include "tests/support/catch.h"

using namespace oracle_test;

TEST_CASE("one update in double equals the brute-force oracle to rounding, feature by feature",
          "[slow]") {
  Case c = jittered_block(6, 5, 7, 0.3, 0.4);
  c.scene.time.order = GENERATE(pbf::TimeOrder::first, pbf::TimeOrder::second);
  CAPTURE(int(c.scene.time.order));
  SECTION("defaults") {}
  SECTION("substeps") { c.scene.solver.substeps = 3; }
  SECTION("the paper's kernels") {
    c.scene.time.order = pbf::TimeOrder::first;
    c.scene.solver.kernels = pbf::KernelMode::paper;
  }
  SECTION("two-sided constraint") { c.scene.solver.constraint = pbf::ConstraintMode::two_sided; }
  SECTION("walls that only clamp") { c.scene.solver.boundary = pbf::BoundaryMode::clamp; }
  SECTION("a wall margin") { c.scene.solver.wall_margin = 0.01; }
  SECTION("artificial pressure") { c.scene.tensile = pbf::Tensile{0.01, 0.25, 4}; }
  SECTION("artificial pressure with an odd exponent") {
    c.scene.tensile = pbf::Tensile{0.01, 0.2, 3};
  }
  SECTION("viscosity") { c.scene.viscosity = pbf::Viscosity{0.3}; }
  SECTION("vorticity confinement") { c.scene.vorticity = pbf::Vorticity{20}; }
  SECTION("vorticity confinement at its limit") { c.scene.vorticity = pbf::Vorticity{1000}; }
  SECTION("everything at once, unfused, damped, other h/d and omega") {
    c.scene.tensile = pbf::Tensile{0.002, 0.3, 4};
    c.scene.viscosity = pbf::Viscosity{0.1};
    c.scene.vorticity = pbf::Vorticity{5};
    c.scene.solver.fused = false;
    c.scene.solver.velocity_damping = 0.99;
    c.scene.fluid.smoothing_ratio = 2.6;
    c.scene.solver.sor = 0.6;
  }
  SECTION("no iterations") {
    c.scene.solver.iterations = 0;
    c.scene.viscosity = pbf::Viscosity{0.3};
  }
  SECTION("a given mass") { c.scene.fluid.mass = 0.009; }
  SECTION("gravity along y") { c.scene.gravity = {1, -9.8, 0}; }
  // In second order, the second update is the first one that takes over a push.
  const Difference d = against_oracle(c, c.scene.time.order == pbf::TimeOrder::second ? 2 : 1);
  // Coordinates up to 50 h from the origin in SI: one rounding of them is 1e-14 h.
  CHECK(d.position < 1e-12);
  CHECK(d.velocity < 2e-12);
}

TEST_CASE("one update is exact in boxes of far more than 2^31 cells, at either end of them",
          "[slow]") {
  Case c = jittered_block(6, 5, 7, 0.3, 0.4);
  const double h = c.scene.h();
  auto &low = c.scene.domain.min, &high = c.scene.domain.max;
  SECTION("one long edge") { high[0] = low[0] + 1e10 * h; }
  SECTION("three long edges") {
    for (std::size_t k = 0; k < 3; ++k) high[k] = low[k] + 1e6 * h;
  }
  SECTION("three long edges, fluid in the far corner") {
    for (std::size_t k = 0; k < 3; ++k) low[k] = high[k] - 1e6 * h;
  }
  double cells = 1;
  for (std::size_t k = 0; k < 3; ++k) cells *= (high[k] - low[k]) / h;
  REQUIRE(cells > 4e9);
  const Difference d = against_oracle(c);
  // Numbers as large as 1e6 h are 1e-10 h apart.
  CHECK(d.position < 2e-9);
  CHECK(d.velocity < 2e-9);
}

TEST_CASE("the default step is exact also for strongly squeezed states and single particles") {
  SECTION("squeezed to 0.6 of the spacing") {
    // One iteration: after it particles clamped to one corner coincide, and their directions are
    // chosen.
    Case c = jittered_block(6, 6, 6, 0.2, 0, 3, 0.6);
    c.scene.solver.iterations = 1;
    CHECK(against_oracle(c).position < 1e-11);
  }
  SECTION("one particle") { CHECK(against_oracle(jittered_block(1, 1, 1, 0, 1)).position < 1e-13); }
  SECTION("two particles") {
    CHECK(against_oracle(jittered_block(2, 1, 1, 0.4, 1)).position < 1e-13);
  }
}

TEST_CASE("float follows double to single rounding over one update") {
  Case c = jittered_block(8, 8, 8, 0.3, 0.4);
  c.scene.viscosity = pbf::Viscosity{};
  auto a = make(c);
  c.scene.precision = pbf::Precision::single;
  auto b = make(c);
  a->step(1);
  b->step(1);
  const auto sa = a->download({}, pbf::ScalarType::f64).get(),
             sb = b->download({}, pbf::ScalarType::f64).get();
  const auto xa = sa.fields[0].as<double>(), xb = sb.fields[0].as<double>();
  double sum = 0, worst = 0;
  for (std::size_t k = 0; k < xa.size(); ++k) {
    const double e = (xa[k] - xb[k]) / c.scene.h();
    sum += e * e;
    worst = std::max(worst, std::fabs(e));
  }
  CHECK(std::sqrt(sum / double(xa.size() / 3)) < 1e-6);  // measured 2e-7
  CHECK(worst < 1e-5);
  CHECK(worst > 0);  // else both ran in the same precision
}

TEST_CASE("1 and 2 threads give the same bits after 50 updates with every feature on", "[slow]") {
  Case c = jittered_block(20, 20, 50, 0.3, 0.4);  // above the sizes at which threads are used
  c.scene.precision = GENERATE(pbf::Precision::single, pbf::Precision::dbl);
  c.scene.tensile = pbf::Tensile{};
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.vorticity = pbf::Vorticity{};
  c.scene.threads = 1;
  auto a = make(c);
  c.scene.threads = 2;
  auto b = make(c);
  a->step(50);
  b->step(50);
  const auto sa = a->download({"velocity", "density"}, pbf::ScalarType::f64).get();
  const auto sb = b->download({"velocity", "density"}, pbf::ScalarType::f64).get();
  for (std::size_t f = 0; f < sa.fields.size(); ++f)
    CHECK(sa.fields[f].bytes == sb.fields[f].bytes);
  const auto ma = a->diagnose(), mb = b->diagnose();
  CHECK(ma.kinetic_energy == mb.kinetic_energy);
  CHECK(ma.compression_mean == mb.compression_mean);
}

TEST_CASE("measuring and downloading do not change the trajectory") {
  Case c = jittered_block(8, 8, 8, 0.3, 0.4);
  auto a = make(c), b = make(c);
  for (int k = 0; k < 20; ++k) {
    a->step(1);
    b->step(1);
    b->diagnose();
    b->download({"density"}, pbf::ScalarType::f32).get();
  }
  CHECK(a->download({}, pbf::ScalarType::f64).get().fields[0].bytes ==
        b->download({}, pbf::ScalarType::f64).get().fields[0].bytes);
}
