// Where paths end that meet an obstacle, against a search for the first place of the path inside
// that knows of the solid only what is inside.
#include <random>

#include "kernels/boundary/keep_out.h"
#include "tests/oracle/obstacle_samples.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using namespace pbf;

namespace {

template <class Real>
Point point(Vec3<Real> x) {
  return {double(x.x), double(x.y), double(x.z)};
}
Point between(const Point& a, const Point& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// The time of the deepest place of the way from a to b; the level is convex along it.
double deepest(const Level& level, const Point& a, const Point& b) {
  const double golden = 0.6180339887498949;
  double low = 0, high = 1;
  for (int i = 0; i < 70; ++i) {
    const double s = high - golden * (high - low), t = low + golden * (high - low);
    if (level(between(a, b, s)) < level(between(a, b, t)))
      high = t;
    else
      low = s;
  }
  return 0.5 * (low + high);
}

std::vector<ObstacleSample> samples(int dimensions) {
  auto all = obstacle_samples(dimensions);
  const Vec3<double> thin{0.005, 2, 1.5};  // a plate of 0.01 h
  all.push_back(sample("thin plate", ObstacleShape::box, thin, dimensions));
  all.push_back(sample("turned thin plate", ObstacleShape::box, thin, dimensions, {0, 1, 0}, 1));
  if (dimensions == 3)
    all.push_back(sample("thin plate aslant", ObstacleShape::box, thin, 3, {3, 1, 2}, 2));
  return all;
}

/// Paths of 0.001 h to 100 h near the obstacle, a tenth of them from its surface.
template <int D, class Real>
void random_paths(const ObstacleSample& s, int count) {
  const auto o = as<Real>(s.obstacle);
  const double fine = sizeof(Real) == 4 ? 3e-5 : 1e-11;  // rounding of bodies' coordinates
  std::mt19937 random(19);
  std::uniform_real_distribution<double> u(-1, 1);
  std::normal_distribution<double> normal;
  int met = 0, free = 0;
  for (int i = 0; i < count; ++i) {
    const auto& c = s.obstacle.center;
    const double r = s.reach + 1;
    Point start{c.x + r * u(random), D == 2 ? 0 : c.y + r * u(random), c.z + r * u(random)};
    if (s.level(start) < 0) continue;
    const double length = 0.001 * std::pow(1e5, 0.5 + 0.5 * u(random));
    Point way{normal(random), D == 2 ? 0 : normal(random), normal(random)};
    const Point in{c.x + 0.3 * u(random), D == 2 ? 0 : c.y + 0.3 * u(random),
                   c.z + 0.3 * u(random)};
    if (i % 3)  // towards the solid
      for (int k = 0; k < 3; ++k) way[k] = in[k] - start[k] + 0.3 * way[k];
    if (D == 2) way[1] = 0;
    const double norm = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    for (double& w : way) w *= length / norm;
    Vec3<Real> from = as<Real>(start);
    if (i % 10 == 0) {  // to the surface first
      from = keep_out<D>(o, from, as<Real>(in)).x;
      start = point(from);
    }
    const Vec3<Real> to = from + as<Real>(way);
    const Point a = point(from), b = point(to);
    const PathEnd<Real> end = keep_out<D>(o, from, to);
    const Point e = point(end.x);
    CAPTURE(s.name, i, a[0], a[1], a[2], b[0], b[1], b[2], e[0], e[1], e[2]);
    const double scale = 1 + length;
    REQUIRE(s.level(e) > -fine * scale);
    const double t = deepest(s.level, a, b), depth = -s.level(between(a, b, t));
    if (depth < -fine * scale) {
      REQUIRE(!end.hit);
      REQUIRE((end.x.x == to.x && end.x.y == to.y && end.x.z == to.z));
      ++free;
    }
    if (depth > fine * scale) {
      REQUIRE(end.hit);
      ++met;
      double outside = 0, inside = t;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (outside + inside);
        (s.level(between(a, b, middle)) < 0 ? inside : outside) = middle;
      }
      // From the first contact the way to the end leads along the solid, not through it. Where the
      // contact is at an edge, rounding decides which face it is at.
      const Point contact = between(a, b, outside);
      const double through = -s.level(between(contact, e, deepest(s.level, contact, e)));
      REQUIRE(through < 20 * fine * scale);
      for (int k = 0; k < 3; ++k) REQUIRE(std::isfinite(e[k]));
    }
    if (D == 2) REQUIRE(end.x.y == Real(0));
  }
  CAPTURE(s.name, met, free);
  CHECK(met > count / 20);
  CHECK(free > count / 20);
}

}  // namespace

TEMPLATE_TEST_CASE(
    "a path that meets an obstacle ends outside on the side where it met it, others "
    "end where they were to",
    "[slow]", float, double) {
  for (const auto& s : samples(3)) random_paths<3, TestType>(s, 10000);
  for (const auto& s : samples(2)) random_paths<2, TestType>(s, 10000);
}

TEMPLATE_TEST_CASE(
    "a particle that is pushed about at a plate of 0.01 h never comes to its other "
    "side in 1e5 steps",
    "", float, double) {
  using Real = TestType;
  std::mt19937 random(29);
  std::normal_distribution<double> normal;
  for (double angle : {0.0, 0.6}) {
    auto s = sample("endless plate", ObstacleShape::box, {3, 3, 0.005}, 3, {1, 2, 1}, angle,
                    x_min | x_max | y_min | y_max);
    s.obstacle.center = {40, 30, 20};  // places with few digits left in float
    const auto o = as<Real>(s.obstacle);
    const auto& turn = s.obstacle.turn[2];
    Vec3<Real> x{Real(40 + turn[0]), Real(30 + turn[1]), Real(20 + turn[2])};  // 1 h above
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
      const double r = i % 100 == 0 ? 20 : 0.1;
      const double down = -0.3 * r;  // more down than up, and back to the middle
      const auto p = x - o.center;
      const Vec3<Real> to = x + Vec3<Real>{Real(r * normal(random) + down * turn[0]) - p.x / 8,
                                           Real(r * normal(random) + down * turn[1]) - p.y / 8,
                                           Real(r * normal(random) + down * turn[2]) - p.z / 8};
      const auto end = keep_out<3>(o, x, to);
      hits += end.hit;
      x = end.x;
      const double above = turn[0] * (double(x.x) - 40) + turn[1] * (double(x.y) - 30) +
                           turn[2] * (double(x.z) - 20);
      REQUIRE(above > 0.005 - (sizeof(Real) == 4 ? 2e-5 : 1e-12));
    }
    CHECK(hits > 20000);
  }
}

TEST_CASE("a path along an obstacle's face keeps all but what leads into it") {
  const auto box = sample("box", ObstacleShape::box, {1, 1, 1}).obstacle;
  const auto plane = sample("plane", ObstacleShape::plane, {}).obstacle;
  const Vec3<double> c = box.center, from = c + Vec3<double>{0.1, 0.2, 1.2};
  for (Vec3<double> way : {Vec3<double>{0.3, -0.4, -0.5}, {80, -40, -30}, {0, 0, -5}}) {
    const auto on_box = keep_out<3>(box, from, from + way);
    const auto on_plane = keep_out<3>(plane, from, from + Vec3<double>{0, 0, -1} + way);
    CAPTURE(way.x);
    if (way.x < 10) CHECK(on_box.hit);
    CHECK(on_plane.hit);
    CHECK(on_plane.x.x == from.x + way.x);
    CHECK(on_plane.x.y == from.y + way.y);
    CHECK(on_plane.x.z == Approx(c.z).epsilon(1e-14));
    if (!on_box.hit) continue;
    CHECK(on_box.x.x == from.x + way.x);
    CHECK(on_box.x.y == from.y + way.y);
    CHECK(on_box.x.z == Approx(c.z + 1).epsilon(1e-14));
  }
}

TEST_CASE("a path from inside an obstacle ends at the nearest place of its surface") {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto check = [&](const ObstacleSample& s, auto dimensions) {
    constexpr int D = decltype(dimensions)::value;
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
      const double r = i == 0 ? 0 : 0.6 * s.reach;  // the centre too
      const auto& c = s.obstacle.center;
      const Vec3<double> x{c.x + r * u(random), D == 2 ? 0 : c.y + r * u(random),
                           c.z + r * u(random)};
      const double depth = -distance<D>(s.obstacle, x);
      if (depth <= 0 || s.body.through) continue;
      ++inside;
      const auto end = keep_out<D>(s.obstacle, x, x);
      const auto way = end.x - x;
      CAPTURE(s.name, depth);
      REQUIRE(end.hit);
      REQUIRE(std::sqrt(dot(way, way)) == Approx(depth).epsilon(1e-9).margin(1e-12));
      REQUIRE(std::fabs(s.level(point(end.x))) < 1e-12);
      REQUIRE(end.x.y - x.y == (D == 2 ? 0 : way.y));
      // Out through that face: nothing holds it.
      const auto out = x + (1 + 0.1 / depth) * way;
      REQUIRE(!keep_out<D>(s.obstacle, x, out).hit);
    }
    if (!s.body.through) CHECK(inside > 0);
  };
  for (const auto& s : samples(3)) check(s, std::integral_constant<int, 3>{});
  for (const auto& s : samples(2)) check(s, std::integral_constant<int, 2>{});
}

TEMPLATE_TEST_CASE("paths without length, from an obstacle's face, and past its edges", "", float,
                   double) {
  using Real = TestType;
  using V = Vec3<Real>;
  // Its faces are numbers without rounding.
  const Solid<Real> box = as<Real>(solid_of({ObstacleShape::box, {1, 1, 1}}));
  const auto unchanged = [](const auto& o, V from, V to) {
    const auto end = keep_out<3>(o, from, to);
    return !end.hit && end.x.x == to.x && end.x.y == to.y && end.x.z == to.z;
  };
  const Real h(0.5);
  CHECK(unchanged(box, {0, 0, 2}, {0, 0, 2}));                   // no length, outside
  CHECK(unchanged(box, {0, 0, 1}, {0, 0, 1}));                   // on a face
  CHECK(unchanged(box, {1, 1, 1}, {1, 1, 1}));                   // on a corner
  CHECK(unchanged(box, {0, 0, 1}, {h, h, 1}));                   // along the face
  CHECK(unchanged(box, {0, 0, 1}, {0, 0, 90}));                  // away from it
  CHECK(unchanged(box, {-2, 0, 1}, {2, 0, 1}));                  // along the face from beside it
  CHECK(unchanged(box, {2, 0, 0}, {0, 0, 2}));                   // touches an edge
  CHECK(unchanged(box, {3, 0, -h}, {-h, 0, 3}));                 // misses it
  CHECK(unchanged(box, {0, 0, 2}, {0, 0, 1}));                   // ends on the face
  const auto slid = keep_out<3>(box, V{0, 0, 1}, V{h, 3, -90});  // from the face to far below
  CHECK(slid.hit);
  CHECK(slid.x.x == h);
  CHECK(slid.x.y == 3);
  CHECK(slid.x.z == 1);
  for (Real deep : {Real(1e-7), Real(1e-4)}) {  // inside by rounding, through to the other side
    const auto kept = keep_out<3>(box, V{0, 0, 1 - deep}, V{0, h, -70});
    CHECK(kept.x.z == Approx(1).epsilon(1e-5));
    CHECK(kept.x.y == h);
    CHECK(unchanged(box, {0, 0, 1 - deep}, {0, h, 2}));  // and out again
  }
  for (auto shape : {ObstacleShape::sphere, ObstacleShape::cylinder, ObstacleShape::capsule}) {
    const Solid<Real> o = as<Real>(solid_of({shape, {1, 0, 2}}));
    CHECK(unchanged(o, {1, 0, 0}, {1, 0, 0}));
    CHECK(unchanged(o, {1, 0, 0}, {1, 5, 0}));                   // along the tangent
    CHECK(unchanged(o, {1, -5, 0}, {1, 5, 0}));                  // touches it
    CHECK(unchanged(o, {1, 0, 0}, {50, 3, 2}));                  // away
    CHECK(unchanged(o, {7, 0, 50}, {7, 1, -50}));                // passes
    const auto end = keep_out<3>(o, V{50, 0, 0}, V{-50, h, 0});  // a bullet
    CHECK(end.hit);
    CHECK(double(end.x.x) < 1);  // it met a slant, and most of its way is left
    CHECK(double(end.x.y) > 10);
    CHECK(double(distance(o, end.x)) > -1e-5);
    const auto on_axis = keep_out<3>(o, V{0, 0, 60}, V{0, 0, -60});
    CHECK(on_axis.hit);
    const Real top = shape == ObstacleShape::sphere ? 1 : shape == ObstacleShape::capsule ? 3 : 2;
    CHECK(double(on_axis.x.z) == Approx(double(top)).epsilon(1e-5));
    const auto short_way = keep_out<3>(o, V{1, 0, 0}, V{Real(1 - 1e-3), Real(1e-3), 0});
    CHECK(short_way.hit);
    CHECK(double(short_way.x.x) == Approx(1).epsilon(1e-6));
    CHECK(double(short_way.x.y) == Approx(1e-3).epsilon(1e-6));
  }
  // Goes on below: a path never comes in there, nor out.
  const Solid<Real> wall = as<Real>(solid_of({ObstacleShape::box, {1, 1, 1}, z_min}));
  CHECK(keep_out<3>(wall, V{0, 0, 1}, V{0, 0, -80}).x.z == 1);
  CHECK(keep_out<3>(wall, V{2, 0, -30}, V{-2, 0, -30}).x.x == 1);
}
