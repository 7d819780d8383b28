// What obstacles add to the density: derivatives, symmetries, range, distance, and the lattice at
// rest.
#include "lib/program/calibrate.h"
#include "tests/oracle/obstacle_samples.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using namespace pbf;

TEMPLATE_TEST_CASE_SIG("an obstacle's gradient is the derivative of its share", "",
                       ((Smoothing S), S), Smoothing::consistent, Smoothing::consistent_2d) {
  constexpr int D = dimensions_of(S);
  constexpr Smoothing paper = D == 2 ? Smoothing::paper_2d : Smoothing::paper;
  for (const auto& s : obstacle_samples(D)) {
    double worst = 0, paper_differs = 0;
    for (const Point& at : places_near(s, D, 2000)) {
      const auto x = as<double>(at);
      const auto g = solid_term<S>(s.obstacle, x, 1 / kRange).gradient;
      const double gradient[3] = {g.x, g.y, g.z}, e = 1e-5;
      for (int k = 0; k < 3; k += D == 2 ? 2 : 1) {
        Point low = at, high = at;
        low[k] -= e, high[k] += e;
        // Beyond the range of an edge the product of slabs is cut off, by 1e-5 at most.
        if ((share<S>(s, low) == 0) != (share<S>(s, high) == 0)) continue;
        const double slope = (share<S>(s, high) - share<S>(s, low)) / (2 * e);
        worst = std::max(worst, std::fabs(gradient[k] - slope));
      }
      const auto p = solid_term<paper>(s.obstacle, x, 1 / kRange).gradient;
      paper_differs = std::max(paper_differs, dot(p - g, p - g));
    }
    CAPTURE(s.name);
    CHECK(worst < 1e-6);
    CHECK(paper_differs == 0);  // Spiky's too
  }
}

TEST_CASE("a turned obstacle adds what the unturned one adds in its coordinates") {
  for (const auto& s : obstacle_samples(3)) {
    auto plain = s.obstacle;
    plain.center = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) plain.turn[i][j] = i == j;
    double worst = 0;
    for (const Point& x : places_near(s, 3, 300)) {
      const auto d = as<double>(x) - s.obstacle.center;
      Point p{}, back{};
      for (int i = 0; i < 3; ++i)
        p[i] =
            s.obstacle.turn[i][0] * d.x + s.obstacle.turn[i][1] * d.y + s.obstacle.turn[i][2] * d.z;
      const auto a = solid_term<Smoothing::consistent>(s.obstacle, as<double>(x), 1 / kRange);
      const auto b = solid_term<Smoothing::consistent>(plain, as<double>(p), 1 / kRange);
      for (int j = 0; j < 3; ++j)
        back[j] = s.obstacle.turn[0][j] * b.gradient.x + s.obstacle.turn[1][j] * b.gradient.y +
                  s.obstacle.turn[2][j] * b.gradient.z;
      worst = std::max({worst, std::fabs(a.share - b.share), std::fabs(a.gradient.x - back[0]),
                        std::fabs(a.gradient.y - back[1]), std::fabs(a.gradient.z - back[2])});
    }
    CAPTURE(s.name);
    CHECK(worst < 1e-12);
  }
}

TEST_CASE("an obstacle's term in float is that in double within 1e-5") {
  for (int dimensions : {2, 3})
    for (const auto& s : obstacle_samples(dimensions)) {
      const auto o = as<float>(s.obstacle);
      double worst = 0, slope = 0;
      for (const Point& x : places_near(s, dimensions, 500)) {
        const auto compare = [&](const auto& a, const auto& b) {
          worst = std::max(worst, std::fabs(a.share - b.share));
          slope = std::max({slope, std::fabs(a.gradient.x - b.gradient.x),
                            std::fabs(a.gradient.y - b.gradient.y),
                            std::fabs(a.gradient.z - b.gradient.z)});
        };
        const float inv = float(1 / kRange);
        if (dimensions == 2)
          compare(solid_term<Smoothing::consistent_2d>(s.obstacle, as<double>(x), 1 / kRange),
                  solid_term<Smoothing::consistent_2d>(o, as<float>(x), inv));
        else
          compare(solid_term<Smoothing::consistent>(s.obstacle, as<double>(x), 1 / kRange),
                  solid_term<Smoothing::consistent>(o, as<float>(x), inv));
      }
      CAPTURE(s.name, worst, slope);
      CHECK(worst < 1e-5);
      CHECK(slope < 1e-4);
    }
}

TEMPLATE_TEST_CASE(
    "an obstacle adds nothing beyond the range, 1 deep inside, and finite numbers "
    "everywhere",
    "", float, double) {
  using Real = TestType;
  std::vector<ObstacleSample> all = obstacle_samples(3);
  for (double radius : {0.0, 0.01, 0.1, 0.3})  // thinner than any scene may have them
    for (auto shape : {ObstacleShape::sphere, ObstacleShape::cylinder, ObstacleShape::capsule})
      all.push_back(sample("thin", shape, {radius, 0, 0.4 * radius}));
  all.push_back(sample("no thickness", ObstacleShape::box, {1, 1, 0}));
  for (const auto& s : all) {
    const auto o = as<Real>(s.obstacle);
    const auto check = [&](const Point& at, const auto& w, Real far) {
      CAPTURE(s.name, at[0], at[1], at[2]);
      REQUIRE(is_finite(w.share));
      REQUIRE(is_finite(dot(w.gradient, w.gradient)));
      REQUIRE(w.share >= Real(-1e-6));
      REQUIRE(w.share <= Real(1 + 1e-6));
      const bool nothing = w.share == Real(0) && dot(w.gradient, w.gradient) == Real(0);
      if (far > Real(kRange + 1e-5)) REQUIRE(nothing);
      if (far < Real(-kRange - 1e-5)) REQUIRE(w.share == Real(1));
    };
    const auto everywhere = [&](const Point& p) {
      const auto x = as<Real>(p);
      const Real inv = Real(1 / kRange), far = distance(o, x);
      check(p, solid_term<Smoothing::consistent>(o, x, inv), far);
      check(p, solid_term<Smoothing::paper>(o, x, inv), far);
      if (s.obstacle.turn[1][1] != 1) return;
      check(p, solid_term<Smoothing::consistent_2d>(o, x, inv), distance<2>(o, x));
      check(p, solid_term<Smoothing::paper_2d>(o, x, inv), distance<2>(o, x));
    };
    const auto& c = s.obstacle.center;
    for (double sx : {-1., 0., 1.})  // corners, edges, middles of faces, the centre
      for (double sy : {-1., 0., 1.})
        for (double sz : {-1., 0., 1.}) {
          const double p[3] = {sx * s.body.half.x, sy * s.body.half.y, sz * s.body.half.z};
          Point x{c.x, c.y, c.z};
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) x[j] += s.obstacle.turn[i][j] * p[i];
          everywhere(x);
        }
    std::mt19937 random(3);
    std::uniform_real_distribution<double> u(-1, 1);
    for (int i = 0; i < 3000; ++i) {
      const double r = i % 3 == 0 ? 1e-3 : i % 3 == 1 ? 3.0 : 1000.0;
      everywhere({c.x + r * u(random), c.y + r * u(random), c.z + r * u(random)});
    }
  }
}

TEST_CASE("an obstacle goes on behind the faces that are none") {
  const auto o = solid_of({ObstacleShape::box, {1, 1, 1}, z_min | x_max}, {1, 2, 3});
  // 10 h more to either side
  const auto longer = solid_of({ObstacleShape::box, {6, 1, 6}}, o.center + Vec3<double>{5, 0, -5});
  for (Vec3<double> p : {Vec3<double>{0.9, 0.2, 0.8}, {1.4, 0.9, 1.1}, {0.3, 1.3, -1.4}}) {
    const auto a = solid_term<Smoothing::consistent>(o, o.center + p, 1 / kRange);
    const auto b = solid_term<Smoothing::consistent>(longer, o.center + p, 1 / kRange);
    CHECK(a.share == Approx(b.share).epsilon(1e-12));
    CHECK(a.gradient.x == Approx(b.gradient.x).margin(1e-12));
    CHECK(a.gradient.z == Approx(b.gradient.z).margin(1e-12));
    CHECK(distance(o, o.center + p) == Approx(distance(longer, o.center + p)).epsilon(1e-12));
  }
}

TEMPLATE_TEST_CASE_SIG("an obstacle's distance reaches its surface and nothing of it is nearer", "",
                       ((int D), D), 2, 3) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (const auto& s : obstacle_samples(D))
    for (const Point& at : places_near(s, D, 100, 1.5)) {
      const double far = distance<D>(s.obstacle, as<double>(at));
      CAPTURE(s.name, far);
      REQUIRE((far < 0) == (s.level(at) < 0));
      Point n{};
      for (int k = 0; k < 3; k += D == 2 ? 2 : 1) {
        Point low = at, high = at;
        low[k] -= 1e-6, high[k] += 1e-6;
        n[k] =
            (distance<D>(s.obstacle, as<double>(high)) - distance<D>(s.obstacle, as<double>(low))) /
            2e-6;
      }
      if (std::fabs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-6)  // else between two faces
        REQUIRE(std::fabs(s.level({at[0] - far * n[0], at[1] - far * n[1], at[2] - far * n[2]})) <
                1e-5);
      for (int i = 0; i < 50; ++i) {
        const Point d{normal(random), D == 2 ? 0 : normal(random), normal(random)};
        const double r =
            0.9999 * std::fabs(far) / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        const double there = s.level({at[0] + r * d[0], at[1] + r * d[1], at[2] + r * d[2]});
        REQUIRE((there < 0) == (far < 0));
      }
    }
}

TEST_CASE("a lattice at rest around an obstacle's edges and corners has density 1 within 1.2 %") {
  const Calibration c = calibrate(KernelMode::consistent, 2);
  const double d = 0.5, a = d / 2;
  const auto fluid = [&](const Point& x, auto wet) {  // lattice points at odd multiples of d/2
    double sum = 0;
    for (double i = -9.5; i < 10; ++i)
      for (double j = -9.5; j < 10; ++j)
        for (double k = -9.5; k < 10; ++k) {
          const Point p{i * d, j * d, k * d};
          const double r = std::sqrt((p[0] - x[0]) * (p[0] - x[0]) + (p[1] - x[1]) * (p[1] - x[1]) +
                                     (p[2] - x[2]) * (p[2] - x[2]));
          if (r < 1 && wet(p)) sum += 15 / kPi * std::pow(1 - r, 3);
        }
    return c.vol * sum;
  };
  const auto with = [&](const Solid<double>& o, const Point& x) {
    return solid_term<Smoothing::consistent>(o, as<double>(x), 1 / c.wall_range).share;
  };
  const auto box = [](Vec3<double> center, Vec3<double> half) {
    return solid_of({ObstacleShape::box, half}, center);
  };
  const auto density = [&](const Solid<double>& o, const Point& x) {
    return fluid(x, [&](const Point& p) { return distance(o, as<double>(p)) > 0; }) +
           c.wall_scale * with(o, x);
  };
  const auto face = box({0, 0, -5}, {20, 20, 5}), edge = box({-5, 0, -5}, {5, 20, 5});
  const auto corner = box({-5, -5, -5}, {5, 5, 5}), plate = box({0, 0, -a}, {20, 20, a});
  CHECK(density(face, {a, a, a}) == Approx(1).margin(1e-6));
  CHECK(density(plate, {a, a, a}) == Approx(1).margin(0.012));
  for (const Point& x : {Point{a, a, -a}, {a, a, a}, {-a, a, a}, {-3 * a, a, a}})
    CHECK(density(edge, x) == Approx(1).margin(0.012));
  for (const Point& x : {Point{a, -a, -a}, {a, a, -a}, {a, a, a}})
    CHECK(density(corner, x) == Approx(1).margin(0.012));

  // Concave: the obstacle is the floor between walls of the domain at x = 0, and y = 0.
  const auto concave = [&](unsigned walls, const Point& x) {
    Box<double> domain;
    domain.extent = {50, 50, 50};
    domain.walls = walls;
    domain.scale = c.wall_scale;
    domain.inv_range = 1 / c.wall_range;
    const double w = domain.term<Smoothing::consistent>(as<double>(x)).density / c.wall_scale;
    return fluid(x,
                 [&](const Point& p) {
                   return p[2] > 0 && p[0] > 0 && (!(walls & y_min) || p[1] > 0);
                 }) +
           c.wall_scale * (1 - (1 - w) * (1 - with(face, x)));
  };
  CHECK(concave(x_min, {a, a, a}) == Approx(1).margin(0.012));
  CHECK(concave(x_min | y_min, {a, a, a}) == Approx(1).margin(0.012));
}
