// Scenes in two dimensions: smoothing functions and walls against quadrature, the update against
// brute force, and what must hold for any of them.
#include <cmath>

#include "kernels/boundary/box.h"
#include "tests/support/against_oracle.h"
#include "tests/support/catch.h"
#include "tests/support/quadrature.h"

using namespace oracle_test;
using namespace pbf;

namespace {

/// From the definition, without the functions under test.
double w(bool paper, double q) {
  if (q >= 1) return 0;
  return paper ? 4 / M_PI * std::pow(1 - q * q, 3) : 10 / M_PI * std::pow(1 - q, 3);
}

double kernel(bool paper, double q) {
  const double t = Spiky<double>::t(q);
  return paper ? density_norm<double, Smoothing::paper_2d>() *
                     density_shape<double, Smoothing::paper_2d>(q * q, t)
               : density_norm<double, Smoothing::consistent_2d>() *
                     density_shape<double, Smoothing::consistent_2d>(q * q, t);
}

/// Share of W beyond a line at distance a, the sum over strips of the disc along the line.
double beyond(bool paper, double a) {
  return integrate(
      [&](double x) {
        const double half = std::sqrt(1 - x * x);
        return integrate([&](double y) { return w(paper, std::hypot(x, y)); }, -half, half, 400);
      },
      a, 1, 400);
}
double beyond_slope(bool paper, double a) {
  const double half = std::sqrt(1 - a * a);
  return -integrate([&](double y) { return w(paper, std::hypot(a, y)); }, -half, half, 4000);
}

Case pool(int nx, int layers, KernelMode kernels) {
  Case c = flat_block(nx, layers, 0, 0);
  c.scene.domain.max[0] = c.scene.domain.min[0] + 0.02 * nx;
  c.scene.domain.max[2] = c.scene.domain.min[2] + 0.04 * layers;
  c.scene.precision = Precision::single;
  c.scene.solver.kernels = kernels;
  return c;
}

}  // namespace

TEST_CASE("smoothing functions in two dimensions integrate to 1 over the unit disc") {
  for (const bool paper : {false, true}) {
    CHECK(integrate([&](double q) { return 2 * M_PI * q * kernel(paper, q); }, 0, 1, 20000) ==
          Approx(1).epsilon(1e-8));
    for (const double q : {0.0, 0.3, 0.9, 1.0, 1.5}) CHECK(kernel(paper, q) == Approx(w(paper, q)));
  }
  for (const double q : {0.01, 0.5, 0.99}) {
    const double e = 1e-6, t = Spiky<double>::t(q);
    CHECK(Spiky<double, 2>::gradient_norm * t * t ==
          Approx((w(false, q + e) - w(false, q - e)) / (2 * e)).epsilon(1e-6));
  }
}

TEST_CASE(
    "a half plane's density is its integral to 2e-4 of rho0, its slope to 3e-3, and the slope "
    "is the density's own derivative") {
  double error[2] = {0, 0}, slope_error[2] = {0, 0};
  for (const bool paper : {false, true}) {
    const auto d = [&](double q) { return paper ? half_plane_poly6(q) : half_plane_spiky(q); };
    for (double q = 0; q < 1; q += 0.02) {
      error[paper] = std::max(error[paper], std::fabs(d(q).density - beyond(paper, q)));
      slope_error[paper] =
          std::max(slope_error[paper], std::fabs(d(q).slope - beyond_slope(paper, q)));
      CHECK(d(q).density > 0);
      CHECK(d(q).slope < 0);
      const double e = 1e-6;
      if (q > e)
        CHECK(d(q).slope ==
              Approx((d(q + e).density - d(q - e).density) / (2 * e)).epsilon(1e-4).margin(1e-9));
    }
    CHECK(d(0.0).density == 0.5);
    CHECK(d(-3.0).density == 0.5);
    CHECK(d(1.0).density == 0);
    CHECK(error[paper] > 1e-6);  // a fit: an error of zero would mean a broken oracle
  }
  CHECK(error[0] < 2.0e-4);
  CHECK(error[1] < 1.0e-4);
  CHECK(slope_error[0] < 2.5e-3);
  CHECK(slope_error[1] < 1.0e-3);
}

TEST_CASE("one update in two dimensions equals the brute-force oracle to rounding, by feature") {
  Case c = flat_block(14, 12, 0.3, 0.4);
  SECTION("defaults") {}
  SECTION("the paper's kernels") { c.scene.solver.kernels = KernelMode::paper; }
  SECTION("two-sided, walls that only clamp, a margin") {
    c.scene.solver.constraint = ConstraintMode::two_sided;
    c.scene.solver.boundary = BoundaryMode::clamp;
    c.scene.solver.wall_margin = 0.01;
  }
  SECTION("artificial pressure, viscosity") {
    c.scene.tensile = Tensile{0.01, 0.25, 4};
    c.scene.viscosity = Viscosity{0.3};
  }
  SECTION("vorticity confinement") { c.scene.vorticity = Vorticity{20}; }
  SECTION("everything at once, unfused, other h/d, gravity along x, a slab of another thickness") {
    c.scene.domain.max[1] += 0.013;
    for (auto& x : c.particles.position) x[1] = *c.scene.plane();
    c.scene.tensile = Tensile{0.002, 0.3, 4};
    c.scene.viscosity = Viscosity{0.1};
    c.scene.vorticity = Vorticity{5};
    c.scene.solver.fused = false;
    c.scene.fluid.smoothing_ratio = 2.6;
    c.scene.gravity = {5, 0, -3};
  }
  SECTION("a given mass") { c.scene.fluid.mass = 0.009; }
  SECTION("squeezed") { c = flat_block(14, 12, 0.2, 0, 3, 0.7), c.scene.solver.iterations = 1; }
  const Difference d = against_oracle(c);
  CHECK(d.position < 1e-12);
  CHECK(d.velocity < 2e-12);
}

TEST_CASE("a square lattice has density 1, and one compressed by 1 % what all pairs add up to") {
  for (const auto kernels : {KernelMode::consistent, KernelMode::paper})
    for (const double ratio : {1.5, 2.0, 3.0}) {
      CAPTURE(int(kernels), ratio);
      Case c = flat_block(15, 15, 0, 0);
      c.scene.domain.open = {"x_min", "x_max", "z_min", "z_max"};
      c.scene.solver.kernels = kernels;
      c.scene.fluid.smoothing_ratio = ratio;
      const auto middle = [&] {
        const auto snap = make(c)->download({"density"}, ScalarType::f64).get();
        return snap.find("density")->as<double>()[7 * 15 + 7] / c.scene.fluid.rest_density;
      };
      CHECK(middle() == Approx(1).epsilon(1e-12));
      for (auto& x : c.particles.position)
        for (const std::size_t k : {0u, 2u})
          x[k] = c.scene.domain.min[k] + std::sqrt(0.99) * (x[k] - c.scene.domain.min[k]);
      const long double d = c.scene.fluid.spacing * sqrtl(0.99L), h = c.scene.h();
      long double squeezed = 0, rest = 0;
      for (int i = -4; i <= 4; ++i)
        for (int k = -4; k <= 4; ++k) {
          const double r = std::hypot(i, k);
          squeezed += w(kernels == KernelMode::paper, double(r * d / h));
          rest += w(kernels == KernelMode::paper, r / ratio);
        }
      CHECK(middle() == Approx(double(squeezed / rest)).epsilon(1e-12));
      CHECK(middle() > 1.003);
    }
}

TEST_CASE(
    "in two dimensions nothing leaves the plane, and without gravity and walls momentum stays") {
  Case c = flat_block(24, 24, 0.3, 0.4);
  c.scene.domain.open = {"x_min", "x_max", "z_min", "z_max"};
  c.scene.gravity = {0, 0, 0};
  c.scene.tensile = Tensile{};
  c.particles.position[5] = c.particles.position[6];  // a direction must be chosen
  auto s = make(c);
  const auto before = s->diagnose();
  s->step(60);
  const auto m = s->diagnose();
  const double scale = 0.4 * 24 * 24 * c.scene.particle_mass();
  for (int k = 0; k < 3; ++k) CHECK(std::fabs(m.momentum[k] - before.momentum[k]) < 1e-12 * scale);
  CHECK(m.momentum[1] == 0);
  const auto snap = s->download({"velocity"}, ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), v = snap.find("velocity")->as<double>();
  for (std::size_t i = 0; i < snap.count; ++i) {
    REQUIRE(x[3 * i + 1] == *c.scene.plane());
    REQUIRE(v[3 * i + 1] == 0);
  }
  CHECK(m.center_of_mass[1] == *c.scene.plane());
}

TEST_CASE("a pool at rest in two dimensions keeps 0.99 of its height and does not pack at walls") {
  for (const auto kernels : {KernelMode::consistent, KernelMode::paper}) {
    CAPTURE(int(kernels));
    const Case c = pool(20, 20, kernels);
    auto s = make(c);
    const auto start = s->diagnose();
    s->step(800);
    const auto m = s->diagnose();
    CHECK(m.height_kept > 0.99);
    CHECK(m.height_kept < 1.01);
    CHECK(m.compression_mean < 0.005);
    CHECK(m.kinetic_energy + m.potential_energy <
          1.01 * (start.kinetic_energy + start.potential_energy));
    // Two spacings of fluid along either side wall and the floor.
    const auto snap = s->download({}, ScalarType::f64).get();
    const auto x = snap.fields[0].as<double>();
    int near[3] = {0, 0, 0};
    for (std::size_t i = 0; i < snap.count; ++i) {
      near[0] += x[3 * i] - c.scene.domain.min[0] < 0.04;
      near[1] += c.scene.domain.max[0] - x[3 * i] < 0.04;
      near[2] += x[3 * i + 2] - c.scene.domain.min[2] < 0.04;
    }
    for (const int n : near) CHECK(n <= 44);  // 40 in the lattice
    for (const int n : near) CHECK(n >= 34);
  }
}

TEST_CASE("in two dimensions 1 and 2 threads give the same bits, energies are those of the slab") {
  Case c = flat_block(90, 40, 0.3, 0.4);  // above the size at which threads are used
  c.scene.precision = GENERATE(Precision::single, Precision::dbl);
  c.scene.tensile = Tensile{};
  c.scene.viscosity = Viscosity{};
  c.scene.vorticity = Vorticity{};
  auto a = make(c);
  c.scene.threads = 2;
  auto b = make(c);
  double energy = 0;  // of the start: rho0 d^2 times the thickness, d here
  for (const auto& v : c.particles.velocity)
    energy += 0.5 * 1000 * 0.02 * 0.02 * 0.02 * (v[0] * v[0] + v[2] * v[2]);
  CHECK(a->diagnose().kinetic_energy == Approx(energy).epsilon(1e-6));
  a->step(15);
  b->step(15);
  const auto x = a->download({"velocity", "density"}, ScalarType::f64).get();
  const auto y = b->download({"velocity", "density"}, ScalarType::f64).get();
  for (std::size_t f = 0; f < x.fields.size(); ++f) CHECK(x.fields[f].bytes == y.fields[f].bytes);
}

TEST_CASE("the direction of a coincident pair in two dimensions is a unit vector of the plane") {
  double mean[2] = {0, 0};
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < i; ++j) {
      const auto a = separation<double, 2>(i, j), b = separation<double, 2>(j, i);
      REQUIRE(dot(a, a) == Approx(1).epsilon(1e-12));
      REQUIRE(a.y == 0);
      REQUIRE(a.x == -b.x);
      REQUIRE(a.z == -b.z);
      mean[0] += b.x / 4950;
      mean[1] += b.z / 4950;
    }
  for (const double m : mean) CHECK(std::fabs(m) < 0.05);
}
