// What viscosity and vorticity confinement keep, and what they may not add.
#include <algorithm>
#include <cmath>

#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using pbf::Double3;

namespace {

/// No walls within reach, no gravity.
void set_free(Case& c, double room) {
  c.scene.gravity = {0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k)
    if (k != 1 || c.scene.dimensions == 3) {
      c.scene.domain.min[k] -= room;
      c.scene.domain.max[k] += room;
    }
}

/// A ball of the lattice around the origin, `radius` spacings wide, that turns about z; random
/// velocities up to `noise` on top, m/s.
Case ball(double d, double radius, double spin, double noise, double room) {
  Case c = here({});
  c.scene.fluid.spacing = d;
  c.scene.time = {0.004, 1, {}};
  c.scene.domain.min.fill(-radius * d);
  c.scene.domain.max.fill(radius * d);
  set_free(c, room);
  std::mt19937 gen(1);
  const int m = int(radius) + 1;
  for (int z = -m; z < m; ++z)
    for (int y = -m; y < m; ++y)
      for (int x = -m; x < m; ++x) {
        const Double3 p{(x + 0.5) * d, (y + 0.5) * d, (z + 0.5) * d};
        if (std::hypot(p[0], p[1], p[2]) > radius * d) continue;
        c.particles.position.push_back(p);
        c.particles.velocity.push_back({-spin * p[1] + noise * random_number(gen),
                                        spin * p[0] + noise * random_number(gen),
                                        noise * random_number(gen)});
      }
  return c;
}

/// A pool in its box, 6 layers of 8 x 8 or larger, with one roll of speed `u` across it.
Case stirred_pool(int nx, int ny, int layers, double u, std::uint32_t seed = 1) {
  const double d = 0.05;
  Case c = here({});
  c.scene.fluid.spacing = d;
  c.scene.time = {0.004, 4, {}};
  c.scene.domain.min = {0, 0, 0};
  c.scene.domain.max = {nx * d, ny * d, 2 * layers * d};
  std::mt19937 gen(seed);
  const double kx = M_PI / (nx * d), kz = M_PI / (layers * d);
  for (int z = 0; z < layers; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const Double3 p{(x + 0.5) * d, (y + 0.5) * d, (z + 0.5) * d};
        c.particles.position.push_back(p);
        c.particles.velocity.push_back(
            {u * std::sin(kx * p[0]) * std::cos(kz * p[2]) + 0.01 * random_number(gen), 0,
             -u * kx / kz * std::cos(kx * p[0]) * std::sin(kz * p[2])});
      }
  return c;
}

/// Mean kinetic energy of measures in the last half of `updates`.
double late_energy(const Case& c, int updates) {
  auto s = make(c);
  double sum = 0;
  s->step(updates / 2);
  for (int k = 0; k < 10; ++k) {
    s->step(updates / 20);
    sum += s->diagnose().kinetic_energy / 10;
  }
  return sum;
}

double angular_momentum(pbf::Solver& s) {
  const pbf::Snapshot snap = s.download({"velocity"}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), v = snap.find("velocity")->as<double>();
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) sum += x[i] * v[i + 1] - x[i + 1] * v[i];
  return sum;
}

}  // namespace

TEST_CASE("viscosity keeps the momentum of over-dense, torn fluid to rounding") {
  const bool flat = GENERATE(false, true);
  Case c = here(flat ? flat_block(20, 20, 0.4, 0.5) : jittered_block(8, 8, 8, 0.4, 0.5));
  c.scene.solver.kernels = GENERATE(pbf::KernelMode::consistent, pbf::KernelMode::paper);
  c.scene.viscosity = pbf::Viscosity{0.3};
  set_free(c, 0.8);
  auto s = make(c);
  const auto before = s->diagnose();
  s->step(30);  // none gets to a wall
  const auto after = s->diagnose();
  const double scale =
      std::sqrt(2 * before.kinetic_energy * 1000 * std::pow(0.02, 3) * double(c.particles.size()));
  for (int k = 0; k < 3; ++k)
    CHECK(std::fabs(after.momentum[k] - before.momentum[k]) < (is_double() ? 1e-14 : 1e-6) * scale);
}

TEST_CASE("viscosity brakes a rigid rotation at its surface alone, by 0.13 c (h/R)^2 an update") {
  const double d = 0.02, h = 0.04, c_factor = 0.1;
  Case c = ball(d, 12, 5, 0, 0.1);
  c.scene.viscosity = pbf::Viscosity{c_factor};
  c.scene.solver.iterations = 0;
  c.scene.time.order = pbf::TimeOrder::first;
  auto s = make(c);
  const double before = angular_momentum(*s);
  s->step(1);
  const pbf::Snapshot snap = s->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto v = snap.find("velocity")->as<double>();
  double inside = 0;
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const auto &x = c.particles.position[i], &old = c.particles.velocity[i];
    if (std::hypot(x[0], x[1], x[2]) < 12 * d - 1.2 * h)
      for (std::size_t k = 0; k < 3; ++k)
        inside = std::max(inside, std::fabs(v[3 * i + k] - old[k]));
  }
  CHECK(inside < 1e-5);
  CHECK(1 - angular_momentum(*s) / before == Approx(0.13 * c_factor / 36).epsilon(0.1));
}

TEST_CASE("vorticity confinement gives a free ball no energy, whatever its epsilon", "[slow]") {
  const double epsilon = GENERATE(1.0, 10.0, 100.0);
  const double spin = GENERATE(3.0, 0.0), noise = GENERATE(0.0, 0.2, 0.5);
  const double ratio = GENERATE(2.0, 3.0);
  if (spin == 0 && noise == 0) return;
  Case c = ball(0.05, 6, spin, noise, 0.4);
  c.scene.fluid.smoothing_ratio = ratio;
  c.scene.vorticity = pbf::Vorticity{epsilon};
  c.scene.time.order =
      pbf::TimeOrder::first;  // the second releases more of the start's compression
  auto s = make(c);
  const double start = s->diagnose().kinetic_energy;
  double most = 0;
  for (int k = 0; k < 20; ++k) {
    s->step(5);  // 0.4 s in all
    most = std::max(most, s->diagnose().kinetic_energy);
  }
  CAPTURE(epsilon, spin, noise, ratio);
  CHECK(most < 1.01 * start);
}

TEST_CASE("a pool comes to rest with vorticity confinement as it does without", "[slow]") {
  Case c = stirred_pool(8, 8, 6, 0.02);
  const double without = late_energy(c, 1000);
  for (const double epsilon : {10.0, 1000.0}) {
    c.scene.vorticity = pbf::Vorticity{epsilon};
    CAPTURE(epsilon);
    CHECK(late_energy(c, 1000) < 1.5 * without);
  }
}

TEST_CASE("the roll in a stirred pool decays more slowly with vorticity confinement", "[slow]") {
  double without = 0, with = 0;
  for (const std::uint32_t seed : {1u, 2u}) {
    Case c = stirred_pool(16, 6, 12, 0.5, seed);
    without += late_energy(c, 250);
    c.scene.vorticity = pbf::Vorticity{1};
    with += late_energy(c, 250);
  }
  CHECK(with > 1.07 * without);
  CHECK(with < 1.5 * without);
}

TEST_CASE("vorticity confinement does as much in an update of several substeps") {
  const auto gained = [](int substeps) {
    Case c = stirred_pool(16, 6, 12, 0.5);
    c.scene.gravity = {0, 0, 0};
    c.scene.solver.substeps = substeps;
    c.scene.solver.iterations = 0;  // so that all the rest is the same
    auto a = make(c);
    c.scene.vorticity = pbf::Vorticity{0.1};
    auto b = make(c);
    a->step(1);
    b->step(1);
    return b->diagnose().kinetic_energy - a->diagnose().kinetic_energy;
  };
  CHECK(gained(4) == Approx(gained(1)).epsilon(0.02));
  CHECK(gained(1) > 0);
}
