// Where free bodies are in a scene, and a run that begins there.
#include "lib/program/free_bodies.h"

#include "lib/program/motion.h"
#include "lib/program/obstacles.h"
#include "lib/scene/vector3.h"
#include "tests/support/catch.h"
#include "tests/support/obstacle_shapes.h"

using namespace pbf;
using namespace pbf_test;

namespace {

Scene scene_of_bodies() {
  using Shape = ObstacleShape;
  Scene s;
  s.domain.max = {4, 4, 4};
  s.fluid.spacing = 0.1;
  s.obstacles = {sphere_obstacle({1, 2, 3}, 0.4),
                 box_obstacle({1, 1, 1}, {1.5, 1.7, 2}, {0.3, -1, 0.2}, 33),
                 box_obstacle({3, 3, 3}, {3.5, 3.7, 3.9}, {0, 0, 1}, 0),
                 sphere_obstacle({2, 2, 0.5}, 0.3),  // fixed
                 tube_obstacle(Shape::cylinder, {2, 1, 1}, {2.5, 1.5, 2}, 0.25),
                 tube_obstacle(Shape::capsule, {3, 1, 1}, {3, 1.5, 2}, 0.2)};
  for (Obstacle& o : s.obstacles)
    if (&o != &s.obstacles[3]) o.free.emplace().density = 500;
  return s;
}

/// Turned by so many degrees about an axis that differs from body to body.
std::vector<BodyMotion> motions(const Scene& s, double degrees) {
  std::vector<BodyMotion> all;
  for (const Obstacle& o : s.obstacles) {
    if (!o.free) continue;
    const double k = double(all.size());
    BodyMotion m;
    m.middle = o.middle() + Double3{0.1 * k, -0.2, 0.3};
    const Matrix3 rows = axes_turned(Double3{1, k - 2, 0.5 * k}, degrees);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) m.turn[a][b] = rows[b][a];
    m.velocity = {1, 2, k};
    m.spin = {0, k, 3.14159265358979323846};
    all.push_back(m);
  }
  return all;
}

double apart(const Vec3<double>& a, const Vec3<double>& b) { return std::sqrt(dot(a - b, a - b)); }

}  // namespace

TEST_CASE("a scene that begins where free bodies are has its solids there") {
  const Scene scene = scene_of_bodies();
  for (const double degrees : {0.0, 1e-6, 30.0, 119.0, 179.9999, 180.0, 250.0}) {
    INFO(degrees << " degrees");
    const std::vector<BodyMotion> now = motions(scene, degrees);
    const Scene begun = begun_with_bodies(scene, now);
    const auto there = solids_of(with_bodies(scene, now)), here = solids_of(begun);
    REQUIRE(here.size() == there.size());
    std::size_t body = 0;
    for (std::size_t k = 0; k < there.size(); ++k) {
      INFO("obstacle " << k);
      CHECK(apart(here[k].center, there[k].center) < 1e-12);
      // Points on three sides are as far from the surface.
      for (const Vec3<double>& way :
           {Vec3<double>{9, 0.3, 0}, Vec3<double>{0.1, 9, 1}, Vec3<double>{1, -2, 9}})
        CHECK(distance<3>(here[k], there[k].center + way) ==
              Approx(distance<3>(there[k], there[k].center + way)).margin(1e-11));
      const Obstacle& o = begun.obstacles[k];
      if (!o.free) {
        CHECK(o == scene.obstacles[k]);
        continue;
      }
      CHECK_FALSE(o.free->now);
      CHECK(o.free->velocity == now[body].velocity);
      CHECK(o.free->angular[2] == Approx(180));
      CHECK(length(o.middle() - now[body++].middle) < 1e-13);
    }
  }
}

TEST_CASE("bodies are placed, and put back by none") {
  const Scene scene = scene_of_bodies();
  const std::vector<BodyMotion> now = motions(scene, 40);
  Scene placed = with_bodies(scene, now);
  CHECK(*placed.obstacles[4].free->now == now[3]);
  CHECK(fastest_obstacle(placed, 0, 1) > fastest_obstacle(scene, 0, 1));
  place_bodies(placed, {});
  CHECK(placed == scene);
  CHECK(names_of_bodies(scene).size() == 5);
}
