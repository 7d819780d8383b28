// What is known without the solver: mass, free fall, rest, momentum, bounded energy.
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/states.h"

using namespace oracle_test;

namespace {

/// A lattice block floating in the middle of a large box.
Case floating_block(int n) {
  Case c = jittered_block(n, n, n, 0.3, 0.1);
  for (std::size_t k = 0; k < 3; ++k) {
    c.scene.domain.min[k] -= 3;
    c.scene.domain.max[k] += 3;
  }
  return c;
}

}  // namespace

TEST_CASE("the centre of mass of a free block follows the discrete parabola to 1e-12 in double") {
  Case c = floating_block(6);
  c.scene.time.order = pbf::TimeOrder::first;
  auto s = make(c);
  const auto m0 = s->diagnose();
  const int n = 200;
  s->step(n);
  const auto m = s->diagnose();
  const double dt = c.scene.time.step, mass = 1000 * std::pow(c.scene.fluid.spacing, 3) * 216;
  for (int k = 0; k < 3; ++k) {
    const double g = c.scene.gravity[std::size_t(k)];
    const double x =
        m0.center_of_mass[k] + m0.momentum[k] / mass * n * dt + g * dt * dt * n * (n + 1) / 2;
    CHECK(std::fabs(m.center_of_mass[k] - x) < 1e-12 * 3);  // 3 m: the scale of the coordinates
    CHECK(std::fabs(m.momentum[k] - (m0.momentum[k] + mass * g * n * dt)) <
          1e-12 * mass * 9.81 * n * dt);
  }
}

TEST_CASE("without gravity and walls momentum is kept to rounding, with viscosity and without") {
  Case c = floating_block(6);
  c.scene.gravity = {0, 0, 0};
  const auto after = [&](double xsph) {
    c.scene.viscosity = pbf::Viscosity{xsph};
    auto s = make(c);
    const auto m0 = s->diagnose();
    s->step(300);
    const auto m = s->diagnose();
    const double scale = 216 * 0.008 * 0.1;
    for (int k = 0; k < 3; ++k) CHECK(std::fabs(m.momentum[k] - m0.momentum[k]) < 1e-12 * scale);
    return m.kinetic_energy;
  };
  const double without = after(0);
  CHECK(after(0.1) < 0.9 * without);  // it does brake
}

TEST_CASE(
    "a tank at rest keeps at least 0.985 of its height and stays below 1 % mean compression") {
  Case c = jittered_block(10, 10, 16, 0, 0);
  c.scene.domain.max = {c.scene.domain.min[0] + 0.2, c.scene.domain.min[1] + 0.2,
                        c.scene.domain.min[2] + 0.6};
  c.scene.precision = pbf::Precision::single;
  auto s = make(c);
  const double e0 = s->diagnose().potential_energy;
  double worst_energy = 0;
  for (int k = 0; k < 30; ++k) {
    s->step(25);
    const auto m = s->diagnose();
    worst_energy = std::max(worst_energy, m.kinetic_energy + m.potential_energy);
  }
  const auto m = s->diagnose();
  const double height = 2 * (m.center_of_mass[2] - c.scene.domain.min[2]) / (16 * 0.02);
  CHECK(height > 0.985);
  CHECK(height < 1.01);
  CHECK(m.compression_mean < 0.01);
  CHECK(m.outside == 0);
  CHECK(m.non_finite == 0);
  CHECK(worst_energy < 1.03 * e0);
}

TEST_CASE("a pool keeps 0.97 of its height with the smallest smoothing ratio that a scene may have",
          "[slow]") {
  for (const int dimensions : {2, 3})
    for (const auto kernels : {pbf::KernelMode::consistent, pbf::KernelMode::paper}) {
      CAPTURE(dimensions, int(kernels));
      Case c = dimensions == 2 ? flat_block(24, 12, 0, 0) : jittered_block(10, 10, 12, 0, 0);
      c.scene.domain.max[0] = c.scene.domain.min[0] + 0.02 * (dimensions == 2 ? 24 : 10);
      c.scene.domain.max[2] = c.scene.domain.min[2] + 0.5;
      c.scene.precision = pbf::Precision::single;
      c.scene.fluid.smoothing_ratio = pbf::least_smoothing_ratio(dimensions);
      c.scene.solver.kernels = kernels;
      auto s = make(c);
      s->step(1000);
      const double height = s->diagnose().height_kept;
      CHECK(height > 0.97);
      CHECK(height < 1.02);
    }
}

TEST_CASE(
    "vorticity confinement up to epsilon = 10 does not raise the energy of a sloshing block") {
  Case c = jittered_block(8, 8, 16, 0.1, 0);
  c.scene.domain.max[0] += 0.3;
  c.scene.precision = pbf::Precision::single;
  auto highest = [&](double epsilon) {
    c.scene.vorticity = pbf::Vorticity{epsilon};
    auto solver = make(c);
    double worst = 0;
    for (int k = 0; k < 40; ++k) {
      const auto m = solver->diagnose();
      worst = std::max(worst, m.kinetic_energy + m.potential_energy);
      solver->step(10);
    }
    return worst;
  };
  const double without = highest(0);
  CHECK(highest(1) < 1.01 * without);
  CHECK(highest(10) < 1.01 * without);
}

TEST_CASE("coincident particles separate, and the same way every time") {
  Case c = floating_block(1);
  c.scene.gravity = {0, 0, 0};
  c.particles.velocity.assign(12, {0, 0, 0});
  c.particles.position.assign(12, c.particles.position[0]);
  auto a = make(c), b = make(c);
  a->step(20);
  b->step(20);
  const auto sa = a->download({}, pbf::ScalarType::f64).get(),
             sb = b->download({}, pbf::ScalarType::f64).get();
  CHECK(sa.fields[0].bytes == sb.fields[0].bytes);
  const auto x = sa.fields[0].as<double>();
  double nearest = 1e9;
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = 0; j < i; ++j)
      nearest = std::min(nearest, std::hypot(x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1],
                                             x[3 * i + 2] - x[3 * j + 2]));
  CHECK(nearest > 0.1 * c.scene.h());
  CHECK(a->diagnose().non_finite == 0);
}
