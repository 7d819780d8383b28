// Obstacles in pictures: their triangles against rays through the kernels' distances, and what
// hides what.
#include "lib/render/solids.h"

#include <optional>
#include <random>

#include "lib/scene/vector3.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

Scene scene_with(std::vector<Obstacle> obstacles) {
  Scene s;
  s.domain.min = {3, -2, 5};
  s.domain.max = {5, -1, 6.5};
  s.fluid.spacing = 0.02;
  s.obstacles = std::move(obstacles);
  return s;
}

constexpr double kNever = 1e9;

/// Distance from the eye at which the ray meets the solid, a little smaller by `less` (m), within
/// `min` and `max`: steps as long as the distance from both allows.
double traced(const Solid<double>& solid, const Double3& min, const Double3& max, double less,
              const Double3& eye, const Double3& ray) {
  double t = 0;
  for (int i = 0; i < 3000 && t < 50; ++i) {
    const Double3 x = eye + t * ray;
    double d = distance<3>(solid, Vec3<double>{x[0], x[1], x[2]}) + less;
    for (std::size_t k = 0; k < 3; ++k)
      d = std::max({d, min[k] - x[k] + less, x[k] - max[k] + less});
    if (d < 1e-9) return t;
    t += d;
  }
  return kNever;
}

/// The same for the triangles; the nearest one.
double met(const std::vector<SolidVertex>& triangles, const Double3& ray) {
  double nearest = kNever;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      const SolidVertex& v = triangles[i + k];
      return Double3{v.place[0], v.place[1], v.place[2]};
    };
    const Double3 a = at(0), u = at(1) - a, w = at(2) - a, p = cross(ray, w);
    const double det = dot(u, p);
    if (det == 0) continue;
    const Double3 q = cross(-1.0 * a, u);
    const double s = dot(-1.0 * a, p) / det, r = dot(ray, q) / det, t = dot(w, q) / det;
    // Rays between two triangles meet both.
    if (s > -1e-5 && r > -1e-5 && s + r < 1 + 1e-5 && t > 0) nearest = std::min(nearest, t);
  }
  return nearest;
}

/// How many of 400 rays from the eye met the first solid; each checked, within `min` and `max`.
int checked_rays(const View& view, const Double3& min, const Double3& max) {
  const Projection p = projection_of(view, 0);
  const std::vector<SolidVertex> triangles = surfaces_of(view, p, {0, 0, 1}).triangles;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> tangent(-0.35, 0.35);
  // Round bodies are inscribed: 0.25 % of their radius, here at most 0.4 m.
  const double off = 1e-3;
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const Double3 seen = unit({tangent(random), tangent(random), 1});
    const Double3 ray = seen[0] * p.right + seen[1] * p.up + seen[2] * p.forward;
    const double outer = traced(view.solids[0], min, max, -1e-5, p.eye, ray);
    const double inner = traced(view.solids[0], min, max, off, p.eye, ray);
    const double drawn = met(triangles, seen);
    if (outer < kNever && inner == kNever) continue;  // touches
    INFO("ray " << i << " outer " << outer << " inner " << inner << " drawn " << drawn);
    CHECK(drawn >= outer - 1e-5);
    CHECK(drawn <= inner + 1e-5);
    hits += drawn < kNever;
  }
  return hits;
}

}  // namespace

TEST_CASE("what is drawn of an obstacle is where rays meet its surface", "[render]") {
  using Shape = ObstacleShape;
  const std::vector<Obstacle> obstacles{
      sphere_obstacle({4, -1.5, 5.7}, 0.4),
      sphere_obstacle({3.1, -1.2, 5.1}, 0.4),  // through two walls and the floor
      box_obstacle({3.6, -1.7, 5.3}, {4.4, -1.3, 5.8}, {0.3, -1, 0.2}, 33),
      box_obstacle({3.6, -1.7, 5}, {4.4, -1.3, 5.4}, {0, 0, 1}, 0),  // on the floor
      box_obstacle({3.2, -2.5, 5.2}, {4.9, -0.5, 5.22}, {0, 1, 0},
                   25),  // a thin plate from wall to wall
      tube_obstacle(Shape::cylinder, {3.7, -1.6, 5.2}, {4.4, -1.3, 6}, 0.25),
      tube_obstacle(Shape::cylinder, {4, -1.5, 4}, {4, -1.5, 8}, 0.3),  // from floor to top
      tube_obstacle(Shape::capsule, {3.6, -1.7, 5.4}, {4.3, -1.3, 6}, 0.2),
      plane_obstacle({4, -1.5, 5.5}, {0.3, -0.1, 1}),
      plane_obstacle({3, -1.5, 5.5}, {0, 0, 2})};
  for (const Obstacle& o : obstacles) {
    const Scene scene = scene_with({o});
    View view = view_of(scene, 1);
    view.camera.target = Double3{4, -1.5, 5.6};
    int hits = 0;
    for (const Double3& eye : {Double3{4.3, -5, 6.5}, Double3{8, 0.5, 8}, Double3{3.5, -1, 1},
                               Double3{3.05, -1.95, 6.4}}) {
      INFO("shape " << o.shape.index() << " at " << &o - obstacles.data() << " eye " << eye[0]);
      view.camera.position = eye;
      hits += checked_rays(view, scene.domain.min, scene.domain.max);
    }
    CHECK(hits > 30);
  }
}

TEST_CASE("an obstacle goes on behind an open face, a plane does not", "[render]") {
  Scene scene =
      scene_with({tube_obstacle(ObstacleShape::cylinder, {4, -1.5, 5}, {4, -1.5, 7.2}, 0.2)});
  scene.domain.open = {"z_max"};
  View view = view_of(scene, 1);
  view.camera.position = Double3{4.3, -6, 7.5};
  CHECK(checked_rays(view, scene.domain.min, {5, -1, 9}) > 20);
  scene.domain.open = {"x_max", "z_min"};
  scene.obstacles = {plane_obstacle({4, -1.5, 5.5}, {0.3, -0.1, 1})};
  view = view_of(scene, 1);
  view.camera.position = Double3{4.3, -6, 7.5};
  CHECK(checked_rays(view, scene.domain.min, scene.domain.max) > 20);
}

TEST_CASE("an eye in an obstacle sees out of it", "[render]") {
  const Scene scene = scene_with({sphere_obstacle({4, -1.5, 5.7}, 0.4)});
  View view = view_of(scene, 1);
  view.camera.position = Double3{4.1, -1.5, 5.7};
  CHECK(surfaces_of(view, projection_of(view, 0), {0, 0, 1}).triangles.empty());
}

TEST_CASE("an obstacle outside of the domain is not drawn", "[render]") {
  for (const Obstacle& o :
       {sphere_obstacle({7, -1.5, 5.7}, 0.4), plane_obstacle({4, -1.5, 4}, {0, 0, 1}),
        box_obstacle({4, -3, 5}, {4.5, -2.1, 6}, {0, 0, 1}, 0)}) {
    const View view = view_of(scene_with({o}), 1);
    CHECK(surfaces_of(view, projection_of(view, 0), {0, 0, 1}).triangles.empty());
  }
}

TEST_CASE("obstacles a million metres from the origin are the same", "[render]") {
  Obstacle o = tube_obstacle(ObstacleShape::capsule, {3.6, -1.7, 5.4}, {4.3, -1.3, 6}, 0.2);
  Scene scene = scene_with({o});
  const auto triangles = [&] {
    const View view = view_of(scene, 1);
    return surfaces_of(view, projection_of(view, 0), {0, 0, 1}).triangles;
  };
  const auto here = triangles();
  for (Double3* p : {&scene.domain.min, &scene.domain.max, &tube_of(scene.obstacles[0]).from,
                     &tube_of(scene.obstacles[0]).to})
    *p = *p + Double3{1e6, -2e6, 3e6};
  const auto there = triangles();
  REQUIRE(!here.empty());
  REQUIRE(there.size() == here.size());
  for (std::size_t i = 0; i < here.size(); ++i) {
    CHECK(there[i].place[0] == Approx(here[i].place[0]).margin(1e-5));
    CHECK(there[i].place[2] == Approx(here[i].place[2]).margin(1e-5));
  }
}

TEST_CASE("of a scene in two dimensions the cut is drawn, at the plane of the particles",
          "[render]") {
  Scene scene = scene_with({});
  scene.dimensions = 2;
  struct Case {
    Obstacle obstacle;
    int least;  // rays that meet it
  };
  for (const Case& c :
       {Case{sphere_obstacle({4, 77, 5.7}, 0.4), 20},
        Case{plane_obstacle({4, 9, 5.5}, {0.3, 0, 1}), 50},
        Case{box_obstacle({3.6, -1.5, 5.3}, {4.4, -1.4, 5.8}, {0, 1, 0}, 33), 20},
        Case{tube_obstacle(ObstacleShape::cylinder, {4, 3, 5.7}, {4, 4, 5.7}, 0.3), 20},
        Case{tube_obstacle(ObstacleShape::capsule, {3.6, 0, 5.4}, {4.3, 0, 6}, 0.2), 20}}) {
    scene.obstacles = {c.obstacle};
    View view = view_of(scene, 1);
    view.camera.position = Double3{4, -6, 5.75};
    const Projection p = projection_of(view, 0);
    const std::vector<SolidVertex> triangles = surfaces_of(view, p, {0, 0, 1}).triangles;
    int hits = 0;
    for (int i = 0; i < 40; ++i)
      for (int k = 0; k < 30; ++k) {
        const Double3 x{3.025 + 0.05 * i, -1.5, 5.025 + 0.05 * k};
        const double away = distance<2>(view.solids[0], Vec3<double>{x[0], x[1], x[2]});
        if (std::abs(away) < 3e-3) continue;  // perspective of the thin slice
        INFO("shape " << c.obstacle.shape.index() << " x " << x[0] << " z " << x[2]);
        const Double3 seen = p.to_view(x);
        const double drawn = met(triangles, unit(seen));
        CHECK((drawn < kNever) == (away < 0));
        if (drawn < kNever) {
          CHECK(drawn == Approx(length(seen)).margin(view.radius));
          ++hits;
        }
      }
    CHECK(hits > c.least);
  }
}

TEST_CASE("particles before an obstacle are seen and those behind it are not", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.radius = 0.2;
  Solid<double> wall;
  wall.shape = shape::Box<double>{{1, 0.01, 1}};  // a thin plate across the view
  view.solids = {wall};
  Renderer renderer(view);
  const auto seen = [&](double y) {
    return pixel(renderer.draw(snapshot({{0, y, 0}}, {1.0})), 100, 100);
  };
  CHECK(chroma(seen(-0.5)) > 60);
  CHECK(chroma(seen(-0.15)) > 60);  // sticks out of it
  CHECK(chroma(seen(0.25)) < 40);
  CHECK(chroma(seen(2)) < 40);
  // Its edge is 79 pixels from the middle: it cuts a particle that reaches from 71 to 95 there.
  const Image cut = renderer.draw(snapshot({{-1.57, 2, 0}}, {1.0}));
  CHECK(chroma(pixel(cut, 23, 100)) < 40);
  CHECK(chroma(pixel(cut, 15, 100)) > 60);
}

TEST_CASE("a particle darkens what is close behind it evenly, without outlines", "[render]") {
  PBF_NEEDS_GL();
  View view = front_view();
  view.radius = 0.1;
  Solid<double> wall;
  wall.shape = shape::Box<double>{{1.5, 0.01, 1.5}};
  view.solids = {wall};
  Renderer renderer(view);
  const Image empty = renderer.draw(snapshot({}, {}));
  const Image image = renderer.draw(snapshot({{0, -0.35, 0}}, {1.0}));
  const auto darker = [&](int x, int y) {
    return double(pixel(empty, x, y)[1]) - pixel(image, x, y)[1];
  };
  // Its own outline has a radius of 9 pixels; its shadow falls below. Around it all
  // is alike.
  double most = 0, uneven = 0;
  for (int r = 13; r < 34; ++r) {
    std::vector<double> ring;
    for (double angle = 0.2; angle < 3; angle += 0.05)
      ring.push_back(darker(int(std::lround(100 + r * std::cos(angle))),
                            int(std::lround(100 - r * std::sin(angle)))));
    const auto [low, high] = std::minmax_element(ring.begin(), ring.end());
    most = std::max(most, *high);
    uneven += (*high - *low) / 21;
  }
  CAPTURE(most, uneven);
  CHECK(most > 8);
  CHECK(uneven < 0.15 * most);
}
