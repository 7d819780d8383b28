// Every shape of the program, and shapes that exist here alone and are known by their distance:
// against functions that say only what is inside.
#include <map>
#include <random>

#include "kernels/boundary/keep_out.h"
#include "lib/render/zero_surface.h"
#include "tests/oracle/obstacle_samples.h"
#include "tests/support/catch.h"
#include "tests/support/test_shapes.h"

namespace {

using namespace pbf;
using namespace pbf_test;
using oracle_test::kRange;
using oracle_test::Level;
using oracle_test::Point;
using V = Vec3<double>;

Point point(const V& x) { return {x.x, x.y, x.z}; }

/// A map of triangles is no closed form: tests/unit/program/mesh_map.cpp.
template <class Shape>
constexpr bool is_map = std::is_same_v<Shape, shape::Mesh<double>>;

/// A shape of this type; a new one of the list needs its line here and in body_level().
template <class Shape>
oracle_test::SampleBody sample_body() {
  using oracle_test::SampleBody;
  if constexpr (std::is_same_v<Shape, shape::Plane<double>>)
    return {ObstacleShape::plane, {}};
  else if constexpr (std::is_same_v<Shape, shape::Box<double>>)
    return {ObstacleShape::box, {1, 1.1, 1.2}};
  else if constexpr (std::is_same_v<Shape, shape::Sphere<double>>)
    return {ObstacleShape::sphere, {1.5, 0, 0}};
  else if constexpr (std::is_same_v<Shape, shape::Cylinder<double>>)
    return {ObstacleShape::cylinder, {1, 0, 1.4}};
  else {
    static_assert(std::is_same_v<Shape, shape::Capsule<double>>);
    return {ObstacleShape::capsule, {1, 0, 1}};
  }
}

/// f(name, shape, level): of every shape of the list.
template <class F>
void for_listed(F&& f) {
  [&]<class... Shape>(const AnyShape<Shape...>*) {
    const auto one = [&]<class S>(const S*) {
      if constexpr (!is_map<S>)
        f("listed " + std::to_string(int(sample_body<S>().shape)),
          sample_body<S>().kernels().template as<S>(),
          Level([](const Point& p) { return body_level(sample_body<S>(), p, 3); }));
    };
    (one(static_cast<const Shape*>(nullptr)), ...);
  }(static_cast<const SomeShape<double>*>(nullptr));
}
Level level_of(const Ellipsoid<double>& e) {
  return [e](const Point& p) {
    const double least = std::min({e.a.x, e.a.y, e.a.z});
    return least * (std::hypot(p[0] / e.a.x, p[1] / e.a.y, p[2] / e.a.z) - 1);
  };
}
const Ellipsoid<double> kEllipsoids[] = {{{3, 2, 1.5}}, {{2, 2, 1}}, {{1.2, 0.9, 0.7}}};

/// And of those that have no closed forms.
template <class F>
void for_all(F&& f) {
  for_listed(f);
  for_listed([&](const std::string& name, const auto& shape, const Level& level) {
    f("bare " + name, Bare<std::decay_t<decltype(shape)>>{shape}, level);
  });
  for (const auto& e : kEllipsoids) f("ellipsoid " + std::to_string(e.a.x), e, level_of(e));
}

/// Within `margin` of the surface, not far from the origin.
template <int D = 3, class Shape>
std::vector<V> places_near(const Shape& s, int count, double margin) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-4, 4);
  std::vector<V> places;
  while (int(places.size()) < count)
    if (const V p{u(random), D == 2 ? 0 : u(random), u(random)};
        std::fabs(s.template distance<D>(p)) < margin)
      places.push_back(p);
  return places;
}

}  // namespace

TEST_CASE("shapes: all fulfil the concept, and one of any kind is plain data that keeps it") {
  static_assert(SolidShape<Ellipsoid<double>, double> && SolidShape<TwoBalls<float>, float>);
  static_assert(std::is_trivially_copyable_v<Solid<float>>);
  for_listed([](const std::string& name, const auto& s, const Level&) {
    using Shape = std::decay_t<decltype(s)>;
    static_assert(SolidShape<Shape, double>);
    const SomeShape<double> any = s;
    int asked = 0;
    CAPTURE(name);
    for (const V& p : places_near(s, 50, 1.5)) {
      const double far = any.with([&](const auto& held) {
        asked += std::is_same_v<std::decay_t<decltype(held)>, Shape>;
        return held.template distance<3>(p);
      });
      CHECK(far == s.template distance<3>(p));
    }
    CHECK(asked == 50);
  });
}

TEST_CASE("shapes: the distance reaches the surface along the normal, and nothing is nearer") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for_all([&](const std::string& name, const auto& s, const Level& level) {
    for (const V& p : places_near(s, 100, 1.5)) {
      const double far = s.template distance<3>(p);
      const V n = s.template normal<3>(p);
      CAPTURE(name, p.x, p.y, p.z, far);
      REQUIRE((far < 0) == (level(point(p)) < 0));
      REQUIRE(dot(n, n) == Approx(1));
      REQUIRE(std::fabs(level(point(p - far * n))) < 1e-7);
      const Tangent<double> t = tangent_of<3>(s, p);
      REQUIRE(dot(t.normal, p) - t.level == Approx(far).margin(1e-9));
      for (int i = 0; i < 50; ++i) {
        const V d = unit_of({normal(random), normal(random), normal(random)});
        REQUIRE((level(point(p + 0.9999 * std::fabs(far) * d)) < 0) == (far < 0));
      }
    }
  });
}

TEST_CASE("shapes: the share is the kernel's integral, without a closed form within 0.004") {
  const auto worst = [](const auto& s, const Level& level) {
    double most = 0;
    for (const V& p : places_near(s, 40, kRange)) {
      const double exact = oracle_test::share_by_rays(level, point(p), kRange, false, 3, 100);
      const auto term = share_of<Smoothing::consistent, false>(s, p, 1 / kRange);
      most = std::max(most, std::fabs(term.share - exact));
      // Its gradient along the normal is the derivative.
      const V n = s.template normal<3>(p);
      const auto at = [&](double t) {
        return share_of<Smoothing::consistent, false>(s, p + t * n, 1 / kRange).share;
      };
      const double slope = (at(1e-5) - at(-1e-5)) / 2e-5;
      CHECK(dot(term.gradient, n) / kRange == Approx(slope).margin(2e-6));
    }
    return most;
  };
  for_listed([&](const std::string& name, const auto& s, const Level& level) {
    CAPTURE(name);
    CHECK(worst(s, level) < 0.0025);
  });
  for (const auto& e : kEllipsoids) {
    CAPTURE(e.a.x);
    const double most = worst(e, level_of(e));
    CHECK(most < 0.005);  // least radii of curvature 0.75, 0.5 and 0.41 h
    // A plane in its place would be off by far more.
    double flat = 0;
    for (const V& p : places_near(e, 40, kRange))
      flat = std::max(
          flat,
          std::fabs(
              half_space_share<Smoothing::consistent, false>(e.distance<3>(p) / kRange).density -
              oracle_test::share_by_rays(level_of(e), point(p), kRange, false, 3, 60)));
    CHECK(flat > 8 * most);
  }
}

TEST_CASE("shapes: in the plane the share without a closed form is the integral too") {
  const Ellipsoid<double> e{{2, 1, 1.2}};
  for (const V& p : places_near<2>(e, 60, kRange)) {
    const double exact = oracle_test::share_by_rays(level_of(e), point(p), kRange, false, 2, 200);
    CAPTURE(p.x, p.z);
    CHECK(share_of<Smoothing::consistent_2d, false>(e, p, 1 / kRange).share ==
          Approx(exact).margin(0.004));
  }
}

TEST_CASE("shapes: steps of the distance enter where closed forms do") {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> u(-4, 4);
  for_listed([&](const std::string& name, const auto& s, const Level&) {
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
      const V a{u(random), u(random), u(random)}, b{u(random), u(random), u(random)};
      if (s.template distance<3>(a) < 0 || s.template distance<3>(b) >= 0) continue;
      Tangent<double> entry, stepped;
      const LineSpan<double> inside = line_span_of<3>(s, a, b - a, entry);
      const LineSpan<double> steps = line_span_by_steps<3>(s, a, b - a, stepped);
      CAPTURE(name, i);
      REQUIRE(steps.enter < steps.leave);
      REQUIRE(steps.enter == Approx(inside.enter).margin(1e-9));
      ++met;
    }
    CHECK(met > 50);
  });
}

TEST_CASE("shapes: no path ends inside or comes through, and those that are free stay") {
  std::mt19937 random(19);
  std::uniform_real_distribution<double> u(-1, 1);
  for_all([&](const std::string& name, const auto& s, const Level& level) {
    int met = 0, free = 0;
    for (int i = 0; i < 4000; ++i) {
      const V a{3 * u(random), 3 * u(random), 3 * u(random)};
      if (s.template distance<3>(a) < 0) continue;
      const double length = std::pow(10, 1.5 * u(random));
      const V b = a + length * unit_of({u(random), u(random), u(random)});
      const WayOut<double> out = way_out<3>(s, BodyFrame<double>{}, a, b);
      const V end = b + out.depth * out.normal;
      double deepest = 1;  // of the way, by places of it
      for (int k = 0; k <= 400; ++k)
        deepest = std::min(deepest, level(point(a + k / 400.0 * (b - a))));
      CAPTURE(name, i, deepest, out.depth);
      REQUIRE(!out.again);
      REQUIRE(level(point(end)) > -1e-7);
      if (deepest < -1e-6) REQUIRE(out.depth > 0);
      if (deepest > 0.02 * length) REQUIRE(out.depth == 0);
      (out.depth > 0 ? met : free) += 1;
    }
    CAPTURE(name);
    CHECK(met > 40);
    CHECK(free > 40);
  });
}

TEST_CASE("shapes: one that is not convex asks once more where a path ended inside") {
  const TwoBalls<double> s{1, 1.2};
  std::mt19937 random(23);
  std::uniform_real_distribution<double> u(-1, 1);
  int once_more = 0, left = 0;
  for (int i = 0; i < 60000; ++i) {
    const V a{2 * u(random), 2 * u(random), 2 * u(random)};
    if (s.distance<3>(a) < 0) continue;
    V b = a + 0.4 * V{u(random), u(random), u(random)};
    bool again = true;
    for (int round = 0; again && round < 4; ++round) {
      const WayOut<double> out = way_out<3>(s, BodyFrame<double>{}, a, b);
      b = b + out.depth * out.normal;
      again = out.again;
      once_more += again;
      REQUIRE(again == (s.distance<3>(b) < -kTouching<double>));
    }
    left += again;
  }
  // However the way passes one ball, it does not leap over the other.
  int through = 0;
  for (int i = 0; i < 20000; ++i) {
    const V a{3 * u(random), 3 * u(random), 3 * u(random)};
    const V b = a + 4.0 * V{u(random), u(random), u(random)};
    double deepest = s.distance<3>(a);
    if (deepest < 0) continue;
    for (int k = 1; k <= 200; ++k)
      deepest = std::min(deepest, s.distance<3>(a + k / 200.0 * (b - a)));
    if (deepest > -0.6) continue;
    ++through;
    CAPTURE(i, deepest);
    REQUIRE(way_out<3>(s, BodyFrame<double>{}, a, b).depth > 0);
  }
  CHECK(through > 100);
  CHECK(once_more > 10);
  CHECK(left < once_more / 4);  // those go back to where they came from
}

TEST_CASE("shapes: bounds and reach hold all that is inside, and end at it") {
  std::mt19937 random(29);
  std::normal_distribution<double> normal;
  for_all([&](const std::string& name, const auto& s, const Level& level) {
    if (!(size_of_shape<double>(s) < kEndless)) return;
    const Bounds<double> b = s.bounds();
    const double size = size_of_shape<double>(s);
    std::vector<V> inside;
    std::uniform_real_distribution<double> u(-3.2, 3.2);
    for (int i = 0; i < 20000; ++i)
      if (const V p{u(random), u(random), u(random)}; level(point(p)) < 0) inside.push_back(p);
    REQUIRE(inside.size() > 100);
    for (const V& p : inside) {
      REQUIRE(b.has(p));
      REQUIRE(std::sqrt(dot(p, p)) <= size);
    }
    for (int i = 0; i < 20; ++i) {
      const V d = unit_of({normal(random), normal(random), normal(random)});
      double most = 0;
      for (const V& p : inside) most = std::max(most, dot(p, d));
      CAPTURE(name, d.x, d.y, d.z);
      REQUIRE(reach_of(s, d) >= most);
      if (!name.starts_with("bare") && !name.starts_with("ellipsoid"))
        CHECK(reach_of(s, d) < most + 0.4);
    }
  });
}

TEST_CASE("shapes: a plane alone has no end, however large a body is") {
  Solid<double> s;
  for (const double half : {1.0, 1e9, 1e12}) {
    s.shape = shape::Box<double>{{half, half, half}};
    CHECK(is_bounded(s));
    s.shape = shape::Sphere<double>{half};
    CHECK(is_bounded(s));
  }
  s.shape = shape::Plane<double>{};
  CHECK(!is_bounded(s));
}

TEST_CASE("shapes: what is drawn of a distance lies on the surface and closes around the body") {
  const Ellipsoid<double> e{{1.2, 0.9, 0.7}};
  double volume = 0;
  for (const Triangle& t : zero_surface(e)) {
    for (const V& p : t) REQUIRE(std::fabs(e.distance<3>(p)) < 1e-3);
    const V area = 0.5 * cross(t[1] - t[0], t[2] - t[0]);
    volume += std::fabs(dot(area, t[0])) / 3;  // seen from the middle all are turned outwards
  }
  CHECK(volume == Approx(4 * std::acos(-1.0) / 3 * 1.2 * 0.9 * 0.7).epsilon(0.005));
}

TEST_CASE("shapes: a section has the area of the shape in its plane, also of one with a waist") {
  const auto area = [](const auto& distance, const V& corner, const V& u, const V& w) {
    double sum = 0;
    for (const auto& polygon : zero_section(distance, corner, u, w))
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        const V a =
            cross(polygon[k].place - polygon[0].place, polygon[k + 1].place - polygon[0].place);
        sum += std::sqrt(dot(a, a)) / 2;
      }
    return sum;
  };
  const double pi = std::acos(-1.0);
  // An ellipsoid where y is 0.3: half axes less by a factor, along both.
  const Ellipsoid<double> e{{1.2, 0.9, 0.7}};
  const auto of_ellipsoid = [&](const V& x) { return e.distance<3>(x); };
  CHECK(area(of_ellipsoid, {-1.3, 0.3, -0.8}, {2.6, 0, 0}, {0, 0, 1.6}) ==
        Approx(pi * 1.2 * 0.7 * (1 - 0.3 * 0.3 / (0.9 * 0.9))).epsilon(0.003));
  CHECK(area(of_ellipsoid, {-0.1, 0.3, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}) == Approx(0.04));
  CHECK(area(of_ellipsoid, {-1.3, 0.95, -0.8}, {2.6, 0, 0}, {0, 0, 1.6}) == 0);
  // Two balls, of radius 1 and 1.6 apart: two circles less what they have in common.
  const TwoBalls<double> two{1, 1.6};
  CHECK(area([&](const V& x) { return two.distance<3>(x); }, {-1.9, -1.1, 0}, {3.8, 0, 0},
             {0, 2.2, 0}) ==
        Approx(2 * pi - (2 * std::acos(0.8) - 0.8 * std::sqrt(4 - 1.6 * 1.6))).epsilon(0.003));
}
