// Standing waves against linear theory, and against what the packing of the particles adds to it.
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/states.h"

using namespace oracle_test;

namespace {

constexpr double kGravity = 9.81;

/// The first mode of a square lattice that fills a tank: k and the frequency of linear theory.
struct Tank {
  Case c;
  double k = 0, omega = 0;
};

Tank tank(int nx, int layers, double spacing, double ratio, double step) {
  Tank t;
  t.c = flat_block(nx, layers, 0, 0);
  t.c.scene.fluid = {1000, spacing, ratio, {}};
  t.c.scene.time.step = step;
  t.c.scene.domain.min = {0, 0, 0};
  t.c.scene.domain.max = {spacing * nx, spacing, 2 * spacing * layers};
  for (int i = 0; i < nx * layers; ++i)
    t.c.particles.position[std::size_t(i)] = {(i % nx + 0.5) * spacing, 0.5 * spacing,
                                              (i / nx + 0.5) * spacing};
  t.k = M_PI / (spacing * nx);
  t.omega = std::sqrt(kGravity * t.k * std::tanh(t.k * spacing * layers));
  return t;
}

/// Velocity of the mode, for a surface that rises by `amplitude` at the walls.
pbf::Double3 mode(const Tank& t, double amplitude, const pbf::Double3& x) {
  const double depth = t.c.scene.domain.max[2] / 2;
  const double scale = amplitude * t.omega / std::sinh(t.k * depth);
  return {-scale * std::cosh(t.k * x[2]) * std::sin(t.k * x[0]), 0,
          scale * std::sinh(t.k * x[2]) * std::cos(t.k * x[0])};
}

/// Frequency over that of linear theory: the fluid settles with damping for `settle` updates, gets
/// the velocities of the mode, and the times at which its share of the velocities changes sign are
/// half a period apart.
double frequency(Tank t, int settle, double amplitude) {
  t.c.scene.solver.velocity_damping = 0.98;
  auto still = make(t.c);
  still->step(settle);
  const auto rest = still->download({}, pbf::ScalarType::f64).get();
  const auto settled = rest.fields[0].as<double>();
  for (std::size_t i = 0; i < t.c.particles.size(); ++i) {
    t.c.particles.position[i] = {settled[3 * i], settled[3 * i + 1], settled[3 * i + 2]};
    t.c.particles.velocity[i] = mode(t, amplitude, t.c.particles.position[i]);
  }
  t.c.scene.solver.velocity_damping = 1;
  auto s = make(t.c);
  const int each = std::max(1, int(2 * M_PI / t.omega / 40 / t.c.scene.time.step));
  std::vector<double> zeros;
  double before = 1;
  for (int k = 1; zeros.size() < 4 && k < 200; ++k) {
    s->step(each);
    const auto now = s->download({"velocity"}, pbf::ScalarType::f64).get();
    const auto x = now.fields[0].as<double>(), v = now.find("velocity")->as<double>();
    double share = 0;
    for (std::size_t i = 0; i < now.count; ++i) {
      const auto u = mode(t, 1, {x[3 * i], x[3 * i + 1], x[3 * i + 2]});
      share += u[0] * v[3 * i] + u[2] * v[3 * i + 2];
    }
    if (k > 1 && share * before < 0)
      zeros.push_back((k - share / (share - before)) * each * t.c.scene.time.step);
    before = share;
  }
  if (zeros.size() < 4) return 0;
  // Slope of time over number, least squares over four sign changes.
  const double half = (3 * (zeros[3] - zeros[0]) + zeros[2] - zeros[1]) / 10;
  return M_PI / half / t.omega;
}

/// 1 + b/chi of the square lattice: its density grows by b e^2 where it is stretched by e along x
/// and compressed by e along z, and by chi per share of its volume that is taken away. Both from
/// sums over the lattice of (1 - r/h)^3, differentiated by hand: with w(r) the kernel, and r after
/// the shear squared x^2 exp(2e) + z^2 exp(-2e).
double square_lattice_factor(double ratio) {
  double chi = 0, b = 0;
  for (int x = -9; x <= 9; ++x)
    for (int z = -9; z <= 9; ++z) {
      const double r = std::hypot(x, z), t = 1 - r / ratio;
      if (!(t > 0) || r == 0) continue;
      const double first = -3 * t * t / ratio, second = 6 * t / ratio / ratio;
      const double c = (x * x - z * z) / (r * r);  // dr = r (c e + (1 - c^2/2) e^2)
      chi += -first * r / 2;
      b += first * r * (1 - c * c / 2) + second * r * r * c * c / 2;
    }
  return 1 + b / chi;
}

}  // namespace

TEST_CASE("with h = 3.5 d a standing wave in 30 layers is at most 2 % off linear theory",
          "[slow]") {
  const double ratio = frequency(tank(50, 30, 0.01, 3.5, 0.0014), 400, 0.01);
  CAPTURE(ratio);  // with h = 2 d 1.048: tests/regression/standing_wave
  CHECK(ratio > 0.98);
  CHECK(ratio < 1.02);
}

TEST_CASE("a square lattice that stays one is as stiff in a wave as its density sum says") {
  // At h = 1.8 d the square lattice is stable. The wave shears it mostly along x and z.
  const double expected = std::sqrt(square_lattice_factor(1.8));
  const double ratio = frequency(tank(50, 15, 0.02, 1.8, 0.002), 300, 0.01);
  CAPTURE(ratio, expected);
  CHECK(expected > 1.2);
  CHECK(ratio > 1 + 0.8 * (expected - 1));
  CHECK(ratio < 1 + 1.1 * (expected - 1));
}
