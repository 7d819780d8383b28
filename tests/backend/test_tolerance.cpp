// Iterations that go on until a tolerance is met (solver.tolerance).
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/pass_residual.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::same_particles;

namespace {

/// Particles closer than at rest, at random places: a mean compression of some 10 %.
Case over_dense() {
  Case c = here(jittered_block(12, 11, 10, 0.3, 0.4));
  c.scene.solver.iterations = 1;
  c.scene.solver.max_iterations = 64;
  c.scene.viscosity = pbf::Viscosity{};
  return c;
}

/// max(rho - 1, 0) of every iteration of an update, averaged on the host.
std::vector<double> mean_compressions(const pbf::StepTrace& t) {
  std::vector<double> out;
  for (const pbf::TraceArray& a : t.arrays) {
    if (a.quantity != "density") continue;
    double sum = 0;
    for (const double rho : a.values) sum += std::max(rho - 1, 0.0);
    out.push_back(sum / double(a.values.size()));
  }
  return out;
}

}  // namespace

TEST_CASE("iterations go on until the mean compression is within the tolerance, and no further") {
  Case fixed = over_dense();
  fixed.scene.solver.sor = 1;  // the default depends on solver.iterations
  fixed.scene.solver.iterations = 24;
  const std::vector<double> all = mean_compressions(make(fixed)->inspection()->trace());
  REQUIRE(all.size() == 24);
  for (const int iterations : {2, 5, 17}) {
    CAPTURE(iterations);
    // Between what iterations - 1 and what `iterations` found.
    const double before = all[std::size_t(iterations - 2)], now = all[std::size_t(iterations - 1)];
    REQUIRE(now < before);
    Case c = over_dense();
    c.scene.solver.sor = 1;
    c.scene.solver.tolerance = std::sqrt(before * now);
    auto solver = make(c);
    solver->step(1);
    CHECK(solver->diagnose().iterations_done == iterations);
    Case asked = over_dense();
    asked.scene.solver.sor = 1;
    asked.scene.solver.iterations = iterations;
    auto expected = make(asked);
    expected->step(1);
    CHECK(same_particles(solver->state(), expected->state()));
  }
}

TEST_CASE("whole repeats of the iterations follow, and no more than max_iterations allows") {
  Case c = over_dense();
  c.scene.solver.iterations = 3;
  c.scene.solver.max_iterations = 8;
  c.scene.solver.tolerance = 1e-9;
  auto solver = make(c);
  solver->step(2);
  CHECK(solver->diagnose().iterations_done == 2 * 6);
  c.scene.solver.tolerance = 1;
  solver = make(c);
  solver->step(2);
  CHECK(solver->diagnose().iterations_done == 2 * 3);
}

TEST_CASE("a tolerance is met in the same iterations in one call, in many, and pass by pass",
          "[slow]") {
  Case c = over_dense();
  c.scene.solver.iterations = 2;
  c.scene.solver.substeps = 2;
  c.scene.solver.method = pbf::SolverMethod::chebyshev;
  c.scene.solver.tolerance = 0.002;
  auto once = make(c), singly = make(c), traced = make(c);
  constexpr int updates = 75;  // a graph of 64, one of 8, and three by themselves
  once->step(updates);
  for (int u = 0; u < updates; ++u) singly->step(1);
  for (int u = 0; u < updates; ++u) traced->inspection()->trace();
  const auto iterations = once->diagnose().iterations_done;
  CHECK(iterations > 4 * updates);
  CHECK(iterations < 4 * 16 * updates);
  CHECK(singly->diagnose().iterations_done == iterations);
  CHECK(traced->diagnose().iterations_done == iterations);
  CHECK(same_particles(once->state(), singly->state()));
  CHECK(same_particles(once->state(), traced->state()));
}

TEST_CASE("a residual counts compression alone, and what is no number as the most") {
  const double density[] = {1.5, 0.2, 1, std::numeric_limits<double>::quiet_NaN(), 1e300, 1 + 1e-9};
  const pbf::ResidualPass<double> pass{density};
  const std::uint64_t one = std::uint64_t(1) << 32;
  CHECK(pass(0) == one / 2);
  CHECK(pass(1) == 0);
  CHECK(pass(2) == 0);
  CHECK(pass(3) == 8 * one);
  CHECK(pass(4) == 8 * one);
  CHECK(pass(5) == 4);  // 1e-9 is 4.29 units
  CHECK(pbf::residual_limit(0.25, 4) == one);
}
