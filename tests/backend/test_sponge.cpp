// Sponges against their formula, on particles that nothing else acts on.
#include <cmath>

#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using pbf::TimeOrder;

namespace {

/// Particles along the diagonal of a box, far from each other and from walls, all with one
/// velocity.
Case line(TimeOrder order, int substeps = 1) {
  Case c = backend_test::drifting(0.01, order);
  c.scene.domain.min = {-1, -2, -3};
  c.scene.domain.max = {3, 2, 1};
  c.scene.solver.substeps = substeps;
  c.scene.solver.hyperviscosity = 0;
  for (int k = 0; k < 12; ++k) {
    c.particles.position.push_back({0.2 * k, 0.3 * k - 1.7, 0.25 * k - 2.6});
    c.particles.velocity.push_back({0.01, -0.02, 0.03});
  }
  return c;
}

/// v/(1 + rate s^n dt) where s is of the place `at` (m) in a zone from low to high, towards high.
double after(double v, double at, double low, double high, bool up, double rate, int n, double dt) {
  if (at < low || at > high) return v;
  const double s = (up ? at - low : high - at) / (high - low);
  return v / (1 + rate * dt * std::pow(s, n));
}

}  // namespace

TEST_CASE(
    "in a sponge velocities decay by the power of the way to its face, elsewhere not at all") {
  const TimeOrder order = GENERATE(TimeOrder::first, TimeOrder::second);
  const int profile = GENERATE(1, 2, 3, 4);
  const std::string toward = GENERATE("x_max", "x_min", "y_max", "z_min", "z_max");
  Case c = line(order, GENERATE(1, 3));
  const auto axis = std::size_t(toward[0] - 'x');
  pbf::Sponge zone{"end", {0.5, -1.2, -2.2}, {1.7, 1.2, 0.4}, toward, 20.0, profile, {"x", "z"}};
  c.scene.damping = {zone};
  auto solver = make(c), without = make([&] {
                           Case plain = c;
                           plain.scene.damping.clear();
                           return plain;
                         }());
  const pbf::SolverState before = solver->state();
  solver->step(1);
  without->step(1);
  const pbf::SolverState now = solver->state(), free = without->state();
  const double h = c.scene.h();
  int inside = 0;
  for (std::size_t i = 0; i < now.id.size(); ++i) {
    bool in = true;
    double at = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = c.scene.origin()[a] + h * free.position[3 * i + a];
      in = in && x >= zone.min[a] && x <= zone.max[a];
      if (a == axis) at = x;
    }
    inside += in;
    for (std::size_t a = 0; a < 3; ++a) {
      const double v = free.velocity[3 * i + a];
      CAPTURE(i, a, toward, profile);
      if (!in || a == 1)
        CHECK(now.velocity[3 * i + a] == v);
      else
        CHECK(now.velocity[3 * i + a] == Approx(after(v, at, zone.min[axis], zone.max[axis],
                                                      toward.ends_with("max"), 20, profile, 0.01))
                                             .epsilon(is_double() ? 1e-12 : 2e-6));
    }
  }
  CHECK(inside >= 3);
  CHECK(inside <= 9);
}

TEST_CASE("fluid that stands still in a sponge has the bits of a run without one") {
  Case c = here(jittered_block(8, 8, 8, 0, 0));
  c.scene.gravity = {};
  c.scene.solver.iterations = 0;  // what corrects positions moves particles
  c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
  auto without = make(c);
  const pbf::Double3 low = c.scene.domain.min, high = c.scene.domain.max;
  c.scene.damping = {{"all", low, high, "x_max", 50.0, 1, {"x", "y", "z"}}};
  auto with = make(c);
  without->step(20), with->step(20);
  CHECK(backend_test::same_particles(without->state(), with->state()));
  CHECK(with->state().velocity[0] == 0);
}

TEST_CASE("a sponge in two dimensions has no ends along y, and several act one after the other") {
  Case c = here(flat_block(8, 8, 0.1, 0));
  c.scene.gravity = {0, 0, 0};
  c.scene.solver.iterations = 0;
  c.scene.solver.hyperviscosity = 0;
  for (pbf::Double3& v : c.particles.velocity) v = {0.01, 0, 0.02};
  pbf::Sponge zone{"a", {-9, 5, -9}, {9, 6, 9}, "x_max", 10.0, 1, {"x", "y", "z"}};
  c.scene.damping = {zone, zone};
  auto solver = make(c);
  solver->step(1);
  const pbf::SolverState s = solver->state();
  const double dt = c.scene.time.step;
  for (std::size_t i = 0; i < s.id.size(); ++i) {
    const double x = c.scene.origin()[0] + c.scene.h() * s.position[3 * i];
    const double f = 1 / (1 + 10 * dt * (x + 9) / 18);
    CHECK(s.velocity[3 * i] * c.scene.h() == Approx(0.01 * f * f).epsilon(1e-4));
    CHECK(s.velocity[3 * i + 2] * c.scene.h() == Approx(0.02 * f * f).epsilon(1e-4));
  }
}
