// Obstacles of a scene as the kernels see them.
#include "lib/program/obstacles.h"

#include <cmath>

#include "kernels/boundary/box.h"
#include "lib/scene/vector3.h"
#include "tests/support/catch.h"
#include "tests/support/obstacle_shapes.h"
#include "tests/support/quaternion.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// d = 0.1 m, h = 0.2 m.
Scene scene_with(const Obstacle& o) {
  Scene s = parse(kMinimal);
  s.domain.min = {-0.3, 0.1, 2};
  s.domain.max = {1, 1, 4};
  s.obstacles = {o};
  return s;
}
Obstacle box(const Double3& min, const Double3& max, const Double3& axis = {0, 0, 1},
             double angle = 0) {
  return pbf_test::box_obstacle(min, max, axis, angle);
}

}  // namespace

TEST_CASE("solids: a box's axes are turned by the right-hand rule about any axis") {
  for (const Double3& axis : {Double3{0, 0, 2}, {1, 2, -2}, {-3, 0, 4}, {0, -5, 0}, {1e5, 1e5, 0}})
    for (const double degrees : {30.0, -75.5, 90.0, 180.0, 359.0, -360.0}) {
      const double size = std::hypot(axis[0], axis[1], axis[2]);
      const auto all = solids_of(scene_with(box({0, 0.2, 2.5}, {0.4, 0.8, 2.6}, axis, degrees)));
      REQUIRE(all.size() == 1);
      CAPTURE(axis[0], axis[1], axis[2], degrees);
      for (std::size_t k = 0; k < 3; ++k) {
        Double3 e{};
        e[k] = 1;
        const Double3 to = pbf::test::by_quaternion(
            {axis[0] / size, axis[1] / size, axis[2] / size}, degrees * std::acos(-1.0) / 180, e);
        for (std::size_t i = 0; i < 3; ++i) CHECK(all[0].turn[k][i] == Approx(to[i]).margin(1e-14));
      }
      CHECK(all[0].center.x == Approx(0.5 / 0.2));  // from the domain's corner, h
      CHECK(all[0].center.y == Approx(0.4 / 0.2));
      CHECK(all[0].center.z == Approx(0.55 / 0.2));
      const auto body = all[0].shape.as<shape::Box<double>>();
      CHECK(body.half.y == Approx(0.3 / 0.2));
      CHECK(body.half.z == Approx(0.05 / 0.2));
    }
}

TEST_CASE("solids: quarters about a coordinate are exact") {
  const double sine[] = {0, 1, 0, -1}, cosine[] = {1, 0, -1, 0};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int quarter = -4; quarter <= 4; ++quarter) {
      Double3 along{};
      along[axis] = 0.3;
      const Solid<double> s =
          solids_of(scene_with(box({0, 0, 0}, {1, 1, 1}, along, 90.0 * quarter)))[0];
      const auto q = std::size_t(quarter + 4) % 4;
      const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
      CHECK(s.turn[axis][axis] == 1);
      CHECK(s.turn[b][b] == cosine[q]);
      CHECK(s.turn[b][c] == sine[q]);
      CHECK(s.turn[c][b] == -sine[q]);
      CHECK(s.turn[c][c] == cosine[q]);
      CHECK(s.turn[axis][b] == 0);
      CHECK(s.turn[b][axis] == 0);
    }
}

TEST_CASE("solids: faces on walls or behind them are none, those on open faces are") {
  const auto through = [](const Obstacle& o, std::vector<std::string> open = {}) {
    Scene s = scene_with(o);
    s.domain.open = std::move(open);
    return pbf_test::through_of(solids_of(s)[0]);
  };
  CHECK(through(box({0, 0.2, 2.5}, {0.5, 0.5, 3})) == 0);
  CHECK(through(box({-0.3, 0.2, 2.5}, {0.5, 0.5, 3})) == x_min);
  CHECK(through(box({-7, 0.1, 1}, {0.5, 1, 3})) == (x_min | y_min | y_max | z_min));
  CHECK(through(box({0, 0.2, 2.5}, {1, 0.5, 4})) == (x_max | z_max));
  CHECK(through(box({0, 0.2, 2.5}, {1, 0.5, 4}), {"x_max"}) == z_max);
  CHECK(through(box({-0.2999, 0.2, 2.5}, {0.5, 0.5, 3})) == 0);
  // A quarter about z: the body's x is the scene's y, its y the scene's -x.
  CHECK(through(box({-0.5, 0.3, 2.5}, {0.5, 0.5, 3}, {0, 0, 1}, 90)) == x_min);  // at y -0.1
  CHECK(through(box({0, 0, 2.5}, {0.6, 0.9, 3}, {0, 0, 1}, 90)) == 0);
  CHECK(through(box({-0.3, 0.4, 2.5}, {0.1, 0.8, 3}, {0, 0, 1}, 90)) == y_max);  // cube: at x -0.3
  CHECK(through(box({0, 0.2, 2}, {0.5, 0.5, 3}, {0, 0, 1}, 30)) == z_min);
  CHECK(through(box({0, 0.2, 2}, {0.5, 0.5, 3}, {1, 0, 0}, 30)) == 0);
  CHECK(through(box({0, 0.2, 2}, {0.5, 0.5, 3}, {1, 0, 0}, 180)) == z_max);
  const auto tube = [](const Double3& from, const Double3& to) {
    return pbf_test::tube_obstacle(pbf_test::ObstacleShape::cylinder, from, to, 0.3);
  };
  CHECK(through(tube({0.2, 0.5, 2}, {0.2, 0.5, 3})) == z_min);
  CHECK(through(tube({0.2, 0.5, 3}, {0.2, 0.5, 2})) == z_max);
  CHECK(through(tube({0.2, 1.5, 3}, {0.2, 0.7, 3})) == z_min);  // begins behind y_max
  CHECK(through(tube({0.2, 1.5, 3}, {0.2 + 1e-3, 0.7, 3})) == 0);
  CHECK(through(pbf_test::plane_obstacle({0.2, 0.5, 2}, {0, 0, 1})) == 0);
}

TEST_CASE("solids: frames of planes, cylinders and capsules are right-handed, their z as given") {
  for (const Double3& way :
       {Double3{0, 0, 1}, {0, 0, -2}, {3, 0, 0}, {0, -1, 0}, {1, 2, -3}, {1e-9, 1e5, 1}}) {
    const Double3 from{0.1, 0.3, 2.4};
    const Obstacle plane = pbf_test::plane_obstacle(from, way);
    const Obstacle tube =
        pbf_test::tube_obstacle(pbf_test::ObstacleShape::capsule, from, from + way, 0.5);
    const double size = std::hypot(way[0], way[1], way[2]);
    for (const Obstacle& o : {plane, tube}) {
      const Solid<double> s = solids_of(scene_with(o))[0];
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK(s.turn[2][k] == Approx(way[k] / size).margin(1e-9));
        const std::size_t b = (k + 1) % 3, c = (k + 2) % 3;
        CHECK(s.turn[0][b] * s.turn[1][c] - s.turn[0][c] * s.turn[1][b] ==
              Approx(s.turn[2][k]).margin(1e-14));
        double dot = 0;
        for (std::size_t i = 0; i < 3; ++i) dot += s.turn[k][i] * s.turn[b][i];
        CHECK(std::fabs(dot) < 1e-14);
      }
      if (!is_bounded(s)) continue;
      const auto body = s.shape.as<shape::Capsule<double>>();
      CHECK(body.radius == 2.5);
      CHECK(body.half == Approx(size / 2 / 0.2));
    }
  }
}

TEST_CASE("solids: along other axes the same places are inside") {
  Obstacle o = box({0, 0.2, 2.2}, {0.7, 0.6, 2.9}, {1, 2, 3}, 40);
  const Scene s = scene_with(o);
  const Solid<double> here = solids_of(s)[0];
  Axes axes;
  for (int k = 0; k < 3; ++k) axes.of[k] = (k + 2) % 3;
  const Solid<double> there = solids_of(s, axes)[0];
  int inside = 0;
  for (double x = 0; x < 6; x += 0.5)
    for (double y = 0; y < 4; y += 0.5)
      for (double z = 0; z < 6; z += 0.5) {
        const double at[3] = {x, y, z};
        const double a = distance(here, Vec3<double>{x, y, z});
        inside += a < 0;
        CHECK(distance(there, Vec3<double>{at[axes.of[0]], at[axes.of[1]], at[axes.of[2]]}) ==
              Approx(a).margin(1e-13));
      }
  CHECK(inside > 10);
}

}  // namespace pbf::scene_test
