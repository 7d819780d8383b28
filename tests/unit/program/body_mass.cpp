// Mass, center and inertia of free bodies against sums over points, formulas of books and
// other bodies of the same form, and the places where they touch.
#include "lib/program/body_mass.h"

#include <cmath>

#include "lib/scene/surface.h"
#include "tests/support/catch.h"
#include "tests/support/meshes.h"
#include "tests/support/obstacle_shapes.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

constexpr double kPiHere = 3.14159265358979323846;

Scene scene_of_body(int dimensions) {
  Scene s = parse(kMinimal);
  s.dimensions = dimensions;
  return s;
}
Obstacle free_body(Obstacle o, double density = 700) {
  o.free.emplace();
  o.free->density = density;
  return o;
}
Obstacle free_tube(bool capsule, const Double3& from, const Double3& to, double radius) {
  return free_body(pbf_test::obstacle_of(
      capsule ? obstacle_keys::Any(obstacle_keys::Capsule{{from, to, radius}})
              : obstacle_keys::Any(obstacle_keys::Cylinder{{from, to, radius}})));
}

/// The same from points that fill a box of half edge `reach` about the middle evenly (an additive
/// recurrence with irrational steps).
BodyMass drawn_mass(const Scene& s, const Obstacle& o, double reach, int count) {
  const Solid<double> solid = solid_in_metres(o, s);
  const bool flat = s.dimensions == 2;
  const double cell = (flat ? 4 : 8 * reach) * reach * reach / count;
  BodyMass m;
  std::vector<Double3> inside;
  for (int k = 0; k < count; ++k) {
    const auto number = [&](double step) { return reach * (2 * std::fmod(k * step, 1.0) - 1); };
    const double by = flat ? 0 : 0.5497004779019702669;
    Double3 x = o.middle() +
                Double3{number(0.8191725133961644397), number(by), number(0.6710436067037892084)};
    if (flat) x[1] = *s.plane();
    const Vec3<double> at{x[0], x[1], x[2]};
    if ((flat ? distance<2>(solid, at) : distance<3>(solid, at)) < 0) inside.push_back(x);
  }
  m.volume = cell * double(inside.size());
  m.mass = *o.free->density * m.volume;
  for (const Double3& x : inside) m.center = m.center + (1.0 / double(inside.size())) * x;
  for (const Double3& x : inside) {
    const Double3 r = x - m.center;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        m.inertia[i][j] += *o.free->density * cell * ((i == j ? dot(r, r) : 0) - r[i] * r[j]);
  }
  return m;
}

void check_same(const Scene& s, const BodyMass& a, const BodyMass& b, double by, double size) {
  CHECK(a.volume == Approx(b.volume).epsilon(by));
  CHECK(a.mass == Approx(b.mass).epsilon(by));
  for (std::size_t k = 0; k < 3; ++k)
    if (s.dimensions == 3 || k != 1) CHECK(std::fabs(a.center[k] - b.center[k]) < by * size);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (s.dimensions == 3 || (i == 1 && j == 1)) {
        CAPTURE(i, j, a.inertia[i][j], b.inertia[i][j]);
        CHECK(std::fabs(a.inertia[i][j] - b.inertia[i][j]) < by * a.mass * size * size);
      }
}

std::vector<Obstacle> bodies_in_space() {
  return {free_body(pbf_test::box_obstacle({0.1, 0.2, 0.3}, {0.9, 0.4, 0.8}, {1, 2, -2}, 35)),
          free_body(pbf_test::sphere_obstacle({0.4, -3, 2}, 0.3)),
          free_tube(false, {0.1, 0.2, 0.3}, {0.6, 0.5, -0.2}, 0.25),
          free_tube(true, {0.1, 0.2, 0.3}, {0.6, 0.5, -0.2}, 0.25)};
}
std::vector<Obstacle> bodies_in_plane() {
  return {free_body(pbf_test::box_obstacle({0.1, 0, 0.3}, {0.9, 1, 0.5}, {0, 1, 0}, 35)),
          free_body(pbf_test::sphere_obstacle({0.4, 0, 2}, 0.3)),
          free_tube(false, {0.1, 0, 0.3}, {0.1, 1, 0.3}, 0.25),
          free_tube(true, {0.1, 0.5, 0.3}, {0.6, 0.5, -0.2}, 0.25),
          free_tube(true, {0.1, 0.5, 0.3}, {0.1, 0.5, 0.9}, 0.25)};
}

}  // namespace

TEST_CASE("mass, center and inertia of every shape are those of points in it") {
  for (const int dimensions : {2, 3}) {
    const Scene s = scene_of_body(dimensions);
    for (const Obstacle& o : dimensions == 2 ? bodies_in_plane() : bodies_in_space()) {
      CAPTURE(dimensions, o.shape.index());
      const BodyMass m = body_mass(s, o);
      CHECK(m.mass == Approx(700 * m.volume));
      check_same(s, m, drawn_mass(s, o, 0.7, 400000), 0.01, 0.7);
    }
  }
}

TEST_CASE("mass and inertia of round bodies are those of the formulas of mechanics") {
  const Scene s = scene_of_body(3), plane = scene_of_body(2);
  const double r = 0.3, l = 0.8;
  const BodyMass sphere = body_mass(s, free_body(pbf_test::sphere_obstacle({1, 2, 3}, r), 1));
  CHECK(sphere.mass == Approx(4 * kPiHere * r * r * r / 3));
  CHECK(sphere.center == Double3{1, 2, 3});
  const BodyMass drum = body_mass(s, free_tube(false, {0, 0, 0}, {l, 0, 0}, r)),
                 pill = body_mass(s, free_tube(true, {0, 0, 0}, {l, 0, 0}, r));
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(sphere.inertia[k][k] == Approx(0.4 * sphere.mass * r * r));
  CHECK(drum.mass == Approx(700 * kPiHere * r * r * l));
  CHECK(drum.inertia[0][0] == Approx(0.5 * drum.mass * r * r));
  CHECK(drum.inertia[1][1] == Approx(drum.mass * (3 * r * r + l * l) / 12));
  CHECK(drum.inertia[2][2] == Approx(drum.inertia[1][1]));
  // A cylinder and two half balls, each moved by the parallel axes from its own center of mass.
  const double half = 700 * 2 * kPiHere * r * r * r / 3;
  CHECK(pill.mass == Approx(drum.mass + 2 * half));
  CHECK(pill.inertia[0][0] == Approx(drum.inertia[0][0] + 2 * half * 0.4 * r * r));
  const double own = 83.0 / 320 * half * r * r, arm = l / 2 + 3 * r / 8;
  CHECK(pill.inertia[1][1] == Approx(drum.inertia[1][1] + 2 * (own + half * arm * arm)));
  const BodyMass disc = body_mass(plane, free_body(pbf_test::sphere_obstacle({1, 0, 3}, r), 1));
  CHECK(disc.mass == Approx(kPiHere * r * r));
  CHECK(disc.inertia[1][1] == Approx(0.5 * disc.mass * r * r));
  CHECK(disc.inertia[0][0] == 0);
  CHECK(disc.inertia[2][2] == 0);
}

TEST_CASE("a body by its mass has the inertia of one by its density") {
  const Scene s = scene_of_body(3);
  for (Obstacle o : bodies_in_space()) {
    const BodyMass by_density = body_mass(s, o);
    o.free->density.reset();
    o.free->mass = 2 * by_density.mass;
    const BodyMass by_mass = body_mass(s, o);
    CHECK(by_mass.mass == 2 * by_density.mass);
    CHECK(by_mass.volume == by_density.volume);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        CHECK(by_mass.inertia[i][j] == Approx(2 * by_density.inertia[i][j]).margin(1e-9));
  }
}

TEST_CASE("the mesh of a box has the mass, the center and the inertia of the box") {
  const Scene s = scene_of_body(3);
  const Obstacle box =
      free_body(pbf_test::box_obstacle({0.1, 0.2, 0.3}, {0.9, 0.4, 0.8}, {1, 2, -2}, 35));
  const Obstacle mesh = free_body(pbf_test::mesh_obstacle(box.as<obstacle_keys::Box>()));
  check_same(s, body_mass(s, mesh), body_mass(s, box), 1e-12, 1);
}

TEST_CASE("a mesh far from the origin of its file is scaled, turned and moved with its mass") {
  const Scene s = scene_of_body(3);
  // Two boxes of millimeters that do not touch, one above the other, wider one below.
  TriangleMesh two = test::box_mesh({1000, 2000, 0}, {1800, 2400, 200});
  const TriangleMesh upper = test::box_mesh({1000, 2000, 300}, {1200, 2400, 700});
  for (const auto& t : upper.triangle) two.triangle.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  two.vertex.insert(two.vertex.end(), upper.vertex.begin(), upper.vertex.end());
  obstacle_keys::Mesh keys;
  keys.scale = 1e-3, keys.turn_axis = {0, 0, 1}, keys.turn_angle = 90, keys.translate = {5, 1, 0.5};
  keys.surface = std::make_shared<const SolidMesh>("two", "", two);
  const Obstacle o = free_body(pbf_test::obstacle_of(keys));
  const BodyMass m = body_mass(s, o);
  // Where the boxes stand in the scene: (x, y) becomes (5 - y, 1 + x).
  struct Part {
    Double3 middle, edge;
  };
  const Part parts[2] = {{{2.8, 2.4, 0.6}, {0.4, 0.8, 0.2}}, {{2.8, 2.1, 1.0}, {0.4, 0.2, 0.4}}};
  double mass = 0;
  Double3 center{};
  for (const auto& [middle, edge] : parts) {
    const double part = 700 * edge[0] * edge[1] * edge[2];
    mass += part, center = center + part * middle;
  }
  center = (1 / mass) * center;
  CHECK(m.mass == Approx(mass));
  for (std::size_t k = 0; k < 3; ++k) CHECK(m.center[k] == Approx(center[k]));
  Matrix3 inertia{};
  for (const auto& [middle, edge] : parts) {
    const double part = 700 * edge[0] * edge[1] * edge[2];
    const Double3 off = middle - center;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        inertia[i][j] +=
            part * (i == j ? (dot(edge, edge) - edge[i] * edge[i]) / 12 + dot(off, off) : 0) -
            part * off[i] * off[j];
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      CHECK(m.inertia[i][j] == Approx(inertia[i][j]).margin(1e-9));
}

TEST_CASE("an obstacle that is not free, or without end, has no mass") {
  const Scene s = scene_of_body(3);
  CHECK(contains(error_of([&] {
                   body_mass(s, pbf_test::sphere_obstacle({0, 0, 0}, 1));
                 }),
                 "has no mass"));
  CHECK(contains(
      error_of([&] { body_mass(s, free_body(pbf_test::obstacle_of(obstacle_keys::Plane{}))); }),
      "has no mass"));
  CHECK(contact_points(s, pbf_test::obstacle_of(obstacle_keys::Plane{})).empty());
}

TEST_CASE("bodies touch on their surface, as far out as they go along every axis") {
  for (const int dimensions : {2, 3}) {
    const Scene s = scene_of_body(dimensions);
    std::vector<Obstacle> all = dimensions == 2 ? bodies_in_plane() : bodies_in_space();
    for (const Obstacle& o : all) {
      CAPTURE(dimensions, o.shape.index());
      Solid<double> solid = solid_in_metres(o, s);
      solid.center = {}, solid.turn[0][0] = 1;
      const auto points = contact_points(s, o);
      REQUIRE_FALSE(points.empty());
      Double3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
      for (const ContactPoint& p : points) {
        const Vec3<double> at{p.at[0], p.at[1], p.at[2]};
        const double away = solid.shape.with([&](const auto& body) {
          return dimensions == 2 ? body.template distance<2>(at) : body.template distance<3>(at);
        });
        CHECK(away == Approx(-p.radius).margin(1e-12));
        for (std::size_t k = 0; k < 3; ++k) {
          low[k] = std::min(low[k], p.at[k] - p.radius);
          high[k] = std::max(high[k], p.at[k] + p.radius);
        }
      }
      const Bounds<double> box = solid.shape.with([](const auto& body) { return body.bounds(); });
      const double want[3] = {box.high.x, box.high.y, box.high.z};
      for (std::size_t k = 0; k < 3; ++k) {
        if (dimensions == 2 && k == 1) continue;
        if (dimensions == 2 && o.shape.index() == 3 && k == 2) continue;  // a disc along its z
        CHECK(high[k] == Approx(want[k]));
        CHECK(low[k] == Approx(-want[k]));
      }
    }
  }
  CHECK(contact_points(scene_of_body(3), bodies_in_space()[0]).size() == 26);
  CHECK(contact_points(scene_of_body(2), bodies_in_plane()[0]).size() == 8);
  CHECK(contact_points(scene_of_body(3), bodies_in_space()[2]).size() == 42);
}

TEST_CASE("the mesh of a box touches at its corners, along the axes of the body") {
  const Scene s = scene_of_body(3);
  const Obstacle box =
      free_body(pbf_test::box_obstacle({0.1, 0.2, 0.3}, {0.9, 0.4, 0.8}, {1, 2, -2}, 35));
  const auto points = contact_points(s, pbf_test::mesh_obstacle(box.as<obstacle_keys::Box>()));
  REQUIRE(points.size() == 8);
  for (const ContactPoint& p : points) {
    CHECK(std::fabs(p.at[0]) == Approx(0.4));
    CHECK(std::fabs(p.at[1]) == Approx(0.1));
    CHECK(std::fabs(p.at[2]) == Approx(0.25));
  }
}

}  // namespace pbf::scene_test
