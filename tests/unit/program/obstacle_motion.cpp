// How far bodies go in a step.
#include "lib/program/obstacle_motion.h"

#include "tests/support/catch.h"

using namespace pbf;

namespace {

Solid<double> turned_about_y(SomeShape<double> shape, Vec3<double> center, double angle) {
  Solid<double> s;
  s.shape = shape, s.center = center;
  s.turn[0][0] = s.turn[2][2] = std::cos(angle);
  s.turn[2][0] = std::sin(angle), s.turn[0][2] = -s.turn[2][0];
  return s;
}

/// Where a place of the body goes.
Vec3<double> carried(const Vec3<double>& x, const Solid<double>& from, const Solid<double>& to) {
  return to.center + turned_back<3>(to, body_point<3>(from, x));
}

}  // namespace

TEST_CASE("a turning body moves no place in the domain farther than is foreseen") {
  Box<double> walls;
  walls.extent = {10, 10, 10};
  // Its middle is farther from the fluid than the domain is long.
  const shape::Box<double> floor{{100, 100, 100}};
  for (const SomeShape<double>& shape :
       {SomeShape<double>(floor), SomeShape<double>(shape::Sphere<double>{105}),
        SomeShape<double>(shape::Cylinder<double>{100, 100})}) {
    const Solid<double> from = turned_about_y(shape, {5, 5, -99}, 0),
                        to = turned_about_y(shape, {5, 5, -99}, 1e-3);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3<double> x{corner & 1 ? 10. : 0, corner & 2 ? 10. : 0, corner & 4 ? 10. : 0};
      if (distance<3>(from, x) > 0) continue;
      const Vec3<double> way = carried(x, from, to) - x;
      CHECK(std::sqrt(dot(way, way)) <= way_between(from, to, walls));
    }
  }
}

TEST_CASE("a plane moves a place in the domain no farther than by two diagonals' turn") {
  Box<double> walls;
  walls.extent = {10, 10, 10};
  const Solid<double> from = turned_about_y(shape::Plane<double>{}, {5, 5, 5}, 0),
                      to = turned_about_y(shape::Plane<double>{}, {5, 5, 5}, 1e-3);
  CHECK(way_between(from, to, walls) == Approx(2e-3 * std::sqrt(300.)));
}
