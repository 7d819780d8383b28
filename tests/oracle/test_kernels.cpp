// Smoothing functions and walls against quadrature and finite differences.
#include <cmath>

#include "kernels/boundary/box.h"
#include "kernels/smoothing.h"
#include "tests/support/catch.h"
#include "tests/support/quadrature.h"

using namespace oracle_test;
using namespace pbf;

namespace {

double kernel_3d(bool paper, double q) {
  const double t = Spiky<double>::t(q);
  return paper ? Poly6<double>::norm * density_shape<double, Smoothing::paper>(q * q, t)
               : Spiky<double>::norm * density_shape<double, Smoothing::consistent>(q * q, t);
}

/// Fraction of the kernel inside {x > a, y > b}: sum over a fine grid of the octants' points.
double quadrant(bool paper, double a, double b) {
  const int n = 120;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = a + (i + 0.5) * (1 - a) / n, y = b + (j + 0.5) * (1 - b) / n;
      const double s = x * x + y * y;
      if (s < 1)
        sum += 2 * integrate([&](double z) { return kernel_3d(paper, std::sqrt(s + z * z)); }, 0,
                             std::sqrt(1 - s), 60);
    }
  return sum * (1 - a) * (1 - b) / (n * n);
}

}  // namespace

TEST_CASE("smoothing functions integrate to 1 over the unit ball and vanish at its rim") {
  for (bool paper : {false, true}) {
    CHECK(integrate([&](double q) { return 4 * kPi * q * q * kernel_3d(paper, q); }, 0, 1, 20000) ==
          Approx(1).epsilon(1e-8));
    CHECK(kernel_3d(paper, 1) == 0);
    CHECK(kernel_3d(paper, 1.5) == 0);
  }
}

TEST_CASE("the Spiky gradient is the derivative of the Spiky function") {
  for (double q : {0.01, 0.2, 0.5, 0.77, 0.99}) {
    const double e = 1e-6, slope = (kernel_3d(false, q + e) - kernel_3d(false, q - e)) / (2 * e);
    const double t = Spiky<double>::t(q);
    CHECK(Spiky<double>::gradient_norm * t * t == Approx(slope).epsilon(1e-6));
  }
}

TEST_CASE("a half space's density equals the integral of the kernel over it") {
  // Caps: a sphere of radius r has the share (r - a)/(2r) of its area beyond the plane at a.
  for (double a : {0.0, 0.1, 0.25, 0.5, 0.9, 0.999}) {
    for (bool paper : {false, true}) {
      const double exact = integrate(
          [&](double r) { return kernel_3d(paper, r) * 2 * kPi * r * (r - a); }, a, 1, 20000);
      const auto d = paper ? half_space_poly6(a) : half_space_spiky(a);
      CHECK(d.density == Approx(exact).epsilon(1e-6).margin(1e-12));
      const double e = 1e-6;
      const auto lo = paper ? half_space_poly6(a - e) : half_space_spiky(a - e);
      const auto hi = paper ? half_space_poly6(a + e) : half_space_spiky(a + e);
      if (a > e)
        CHECK(d.slope == Approx((hi.density - lo.density) / (2 * e)).epsilon(1e-4).margin(1e-9));
    }
  }
  CHECK(half_space_spiky(0.0).density == 0.5);
  CHECK(half_space_spiky(-3.0).density == 0.5);
  CHECK(half_space_spiky(1.0).density == 0);
  CHECK(half_space_poly6(1.0).density == 0);
}

TEST_CASE("the density at an edge by inclusion-exclusion is within 1 % of rho0 of the integral") {
  double worst = 0;
  for (bool paper : {false, true})
    for (double a : {0.0, 0.15, 0.3, 0.5, 0.7})
      for (double b : {0.0, 0.15, 0.3, 0.5}) {
        const double da = (paper ? half_space_poly6(a) : half_space_spiky(a)).density;
        const double db = (paper ? half_space_poly6(b) : half_space_spiky(b)).density;
        worst = std::max(worst, std::fabs(da * db - quadrant(paper, a, b)));
      }
  CAPTURE(worst);
  CHECK(worst < 0.01);
  CHECK(worst > 1e-5);  // it is an approximation: an error of zero would mean a broken oracle
}

TEST_CASE("the walls' gradient is the derivative of their density in the consistent mode") {
  Box<double> box;
  box.extent = {3, 2.5, 1.6};  // the last one: opposite walls closer than 2 h
  box.scale = 1.2;
  box.inv_range = 1 / 0.7;
  for (Vec3<double> x :
       {Vec3<double>{0.2, 0.3, 0.1}, {2.8, 1.2, 0.8}, {0.5, 2.2, 1.5}, {1.5, 1.2, 0.8}}) {
    const auto g = box.term<Smoothing::consistent>(x).gradient;
    const double e = 1e-6;
    auto density = [&](double dx, double dy, double dz) {
      const Vec3<double> y{x.x + dx, x.y + dy, x.z + dz};
      return box.term<Smoothing::consistent>(y).density;
    };
    CHECK(g.x == Approx((density(e, 0, 0) - density(-e, 0, 0)) / (2 * e)).margin(1e-7));
    CHECK(g.y == Approx((density(0, e, 0) - density(0, -e, 0)) / (2 * e)).margin(1e-7));
    CHECK(g.z == Approx((density(0, 0, e) - density(0, 0, -e)) / (2 * e)).margin(1e-7));
  }
}

TEST_CASE("the direction of a coincident pair is a unit vector, opposite for the two") {
  double mean[3] = {0, 0, 0};
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < i; ++j) {
      const auto a = separation<double>(i, j), b = separation<double>(j, i);
      REQUIRE(dot(a, a) == Approx(1).epsilon(1e-12));
      REQUIRE(a.x == -b.x);
      REQUIRE(a.y == -b.y);
      REQUIRE(a.z == -b.z);
      mean[0] += b.x / 19900;
      mean[1] += b.y / 19900;
      mean[2] += b.z / 19900;
    }
  for (double m : mean) CHECK(std::fabs(m) < 0.03);  // no preferred direction
}
