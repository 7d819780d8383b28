// The sequence of steps and the substeps, against what theory says of them.
#include <algorithm>
#include <cmath>

#include "tests/support/against_oracle.h"
#include "tests/support/catch.h"

using namespace oracle_test;

TEST_CASE("the error polynomial of Chebyshev's steps is as small as any can be on [1/2, 3/2]") {
  for (int iterations : {1, 2, 3, 4, 5, 8, 16}) {
    pbf::Scene s;
    s.solver.method = pbf::SolverMethod::chebyshev;
    s.solver.iterations = iterations;
    const auto factors = pbf::make_plan(s, 1000).sor_factors;
    REQUIRE(int(factors.size()) == iterations);
    double largest = 0;
    for (int k = 0; k <= 1000; ++k) {
      const double eigenvalue = 0.5 + k / 1000.0;
      double p = 1;
      for (double f : factors) p *= 1 - f * eigenvalue;
      largest = std::max(largest, std::fabs(p));
    }
    // 1/T_K((b + a)/(b - a)), T_K(x) = cosh(K arcosh x).
    CHECK(largest == Approx(1 / std::cosh(iterations * std::acosh(2.0))).epsilon(1e-9));
    CHECK(factors.back() <= 1);
  }
  pbf::Scene plain;
  CHECK(pbf::make_plan(plain, 1000).sor_factors.empty());
}

TEST_CASE("substeps are updates of a shorter step, but for pairs that come into reach between") {
  // No distance of the lattice is near h = 2.12 d: hardly a pair comes into reach.
  Case few = jittered_block(8, 8, 8, 0.01, 0);
  few.scene.fluid.smoothing_ratio = 2.12;
  few.scene.precision = pbf::Precision::dbl;
  few.scene.solver.velocity_damping = 0.9;
  few.scene.time.step = 1e-4;
  Case many = few;
  many.scene.time.step /= 4;
  many.scene.solver.velocity_damping = std::pow(0.9, 0.25);
  few.scene.solver.substeps = 4;
  auto a = make(few), b = make(many);
  a->step(5);
  b->step(20);
  const auto x = a->download({}, pbf::ScalarType::f64).get(),
             y = b->download({}, pbf::ScalarType::f64).get();
  const auto p = x.fields[0].as<double>(), q = y.fields[0].as<double>();
  double worst = 0, moved = 0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    worst = std::max(worst, std::fabs(p[k] - q[k]));
    moved = std::max(moved, std::fabs(p[k] - few.particles.position[k / 3][k % 3]));
  }
  CHECK(worst < 1e-3 * moved);
}
