// The share of the kernel in obstacles against quadrature.
#include "tests/oracle/obstacle_samples.h"
#include "tests/support/catch.h"
#include "tests/support/quadrature.h"

using namespace oracle_test;
using namespace pbf;

namespace {

/// Largest error, in rho0.
template <Smoothing S>
double worst_share(const ObstacleSample& s, int count) {
  constexpr int D = dimensions_of(S);
  double worst = 0;
  for (const Point& x : places_near(s, D, count)) {
    const double exact = share_by_rays(s.level, x, kRange, is_paper(S), D, D == 2 ? 200 : 120);
    worst = std::max(worst, kScale * std::fabs(share<S>(s, x) - exact));
  }
  return worst;
}

/// Romberg's rule: exact for polynomials to rounding.
template <class F>
double romberg(F f, double a, double b) {
  double row[7] = {};
  for (int k = 0, n = 1; k < 7; ++k, n *= 2) {
    double sum = 0.5 * (f(a) + f(b));
    for (int i = 1; i < n; ++i) sum += f(a + (b - a) * i / n);
    double before = row[0];
    row[0] = sum * (b - a) / n;
    for (int j = 1; j <= k; ++j) {
      const double next = row[j - 1] + (row[j - 1] - before) / (std::pow(4.0, j) - 1);
      before = row[j];
      row[j] = next;
    }
  }
  return row[6];
}

/// A ball by the shells about a place at distance c from its centre: first those that are wholly
/// solid, then those that are cut.
double ball_by_shells(bool poly6, double c, double radius) {
  const auto shell = [&](double r) {
    return poly6 ? 315 / 16. * r * r * std::pow(1 - r * r, 3) : 60 * r * r * std::pow(1 - r, 3);
  };
  const auto cut = [&](double r) {
    if (r == 0) return 0.0;
    return shell(r) * 0.5 * (1 - (r * r + c * c - radius * radius) / (2 * r * c));
  };
  const double first = std::min(std::fabs(c - radius), 1.0), last = std::min(c + radius, 1.0);
  return (c < radius ? romberg(shell, 0, first) : 0) + romberg(cut, first, last);
}

}  // namespace

TEST_CASE("the obstacles' quadrature along rays gives the half space and the ball") {
  const auto plane = sample("plane", ObstacleShape::plane, {});
  const auto ball = sample("ball", ObstacleShape::sphere, {0.5, 0, 0});
  for (double s : {-0.3, 0.02, 0.35}) {
    CHECK(share_by_rays(plane.level, {0, 0, 2.1 + s}, kRange, false, 3, 200) ==
          Approx(half_space_share<Smoothing::consistent, false>(s / kRange).density).margin(2e-5));
    CHECK(share_by_rays(ball.level, {1.3, -0.4, 2.6 + s}, kRange, true, 3, 200) ==
          Approx(ball_by_shells(true, (0.5 + s) / kRange, 0.5 / kRange)).margin(1e-4));
  }
}

TEST_CASE("an obstacle's share is the kernel's integral over the solid", "[slow]") {
  for (const auto& s : obstacle_samples(3)) {
    CAPTURE(s.name);
    const double worst = worst_share<Smoothing::consistent>(s, 60);
    const auto shape = s.body.shape;
    const bool exact = shape == ObstacleShape::plane || shape == ObstacleShape::sphere;
    // Plates at their corners 0.0022, short capsules in the middle 0.0025; else below 0.002.
    CHECK(worst < (exact ? 6e-4 : shape == ObstacleShape::capsule ? 0.003 : 0.0024));
    if (exact) continue;
    const double paper = worst_share<Smoothing::paper>(s, 20);
    CHECK(paper < 0.007);
  }
}

TEST_CASE("a long cylinder's share is within 0.001 of rho0 of the integral from R = h on") {
  for (double radius : {1.0, 2.0, 5.0}) {
    const auto s = sample("cylinder", ObstacleShape::cylinder, {radius, 0, 9});
    double worst = 0;
    for (double q : {-0.6, -0.3, -0.1, 0.05, 0.2, 0.4, 0.6}) {
      const Point x{1.3 + 0.6 * (radius + q), -0.4 + 0.8 * (radius + q), 2};
      const double exact = share_by_rays(s.level, x, kRange, false, 3, 200);
      worst = std::max(worst, kScale * std::fabs(share<Smoothing::consistent>(s, x) - exact));
    }
    CAPTURE(radius);
    CHECK(worst < 0.001);
  }
}

TEST_CASE("an obstacle's share in the plane is the kernel's integral over its section", "[slow]") {
  for (const auto& s : obstacle_samples(2)) {
    CAPTURE(s.name);
    const double worst = worst_share<Smoothing::consistent_2d>(s, 100);
    const double paper = worst_share<Smoothing::paper_2d>(s, 100);
    CHECK(worst < (s.body.shape == ObstacleShape::box ? 0.004 : 0.002));
    CHECK(paper < 0.007);
  }
}

TEST_CASE("an obstacle's sphere is exact for every radius, its centre included") {
  for (double radius : {0.3, 0.4, 0.7, 1.0, 3.0, 10.0}) {
    const Solid<double> o = solid_of({ObstacleShape::sphere, {radius, 0, 0}});
    double worst = 0;
    for (double c = 0.003; c < radius + kRange; c += c < 0.1 ? 0.007 : 0.041)
      for (bool poly6 : {false, true}) {
        const Vec3<double> x{0.6 * c, 0, 0.8 * c};
        const double is = poly6 ? solid_term<Smoothing::paper>(o, x, 1 / kRange).share
                                : solid_term<Smoothing::consistent>(o, x, 1 / kRange).share;
        worst = std::max(worst, std::fabs(is - ball_by_shells(poly6, c / kRange, radius / kRange)));
      }
    CAPTURE(radius, worst);
    CHECK(worst < 1e-12);
    const auto middle = solid_term<Smoothing::consistent>(o, {}, 1 / kRange);
    CHECK(middle.share ==
          Approx(4 * kPi * kernel_within(false, 3, radius / kRange)).epsilon(1e-13));
    CHECK(middle.gradient.x == 0);
  }
}

TEST_CASE("what an obstacle's curvature takes away is the kernel's moment, in the plane by a fit") {
  const auto by_quadrature = [](auto w, int dimensions, double q) {
    // r^2 = q^2 + y^2, r dr = y dy
    return integrate(
        [&](double y) {
          const double r = std::sqrt(q * q + y * y);
          return (dimensions == 2 ? y * y : kPi * y * y * y) * w(r);
        },
        0, std::sqrt(1 - q * q), 4000);
  };
  for (double q = -0.975; q < 1; q += 0.05) {
    CHECK(curvature_moment<Smoothing::consistent, false>(q).density ==
          Approx(by_quadrature([](double r) { return 15 / kPi * std::pow(1 - r, 3); }, 3, q))
              .margin(1e-7));
    CHECK(curvature_moment<Smoothing::paper, true>(q).density ==
          Approx(by_quadrature([](double r) { return 315 / (64 * kPi) * std::pow(1 - r * r, 3); },
                               3, q))
              .margin(1e-7));
    CHECK(curvature_moment<Smoothing::paper_2d, true>(q).density ==
          Approx(by_quadrature([](double r) { return 4 / kPi * std::pow(1 - r * r, 3); }, 2, q))
              .margin(1e-7));
    CHECK(curvature_moment<Smoothing::consistent_2d, false>(q).density ==
          Approx(by_quadrature([](double r) { return 10 / kPi * std::pow(1 - r, 3); }, 2, q))
              .margin(7e-5));
  }
}
