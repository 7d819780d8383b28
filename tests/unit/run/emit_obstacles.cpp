// Particles of bodies that are in obstacles, or nearer to one than 0.4 spacings, are left out.
#include <cmath>

#include "lib/run/emit.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

Scene with_obstacle(const std::string& obstacle, const std::vector<std::string>& set = {}) {
  return parse(kMinimal + "obstacles: [{name: a, " + obstacle + "}]\n", set);
}

/// What is left of the 10 x 10 x 5 lattice of kMinimal where `far` (m) says how far a place is.
template <class F>
void check_left(const Scene& s, F far) {
  std::vector<Double3> left;
  for (double z = 0; z < 5; ++z)
    for (double y = 0; y < 10; ++y)
      for (double x = 0; x < 10; ++x) {
        const Double3 at{0.1 * (x + 0.5), 0.1 * (y + 0.5), 0.1 * (z + 0.5)};
        if (far(at) >= 0.04) left.push_back(at);
      }
  const Particles p = emit_particles(s, "");
  CHECK(left.size() > 100);
  CHECK(left.size() < 490);
  REQUIRE(p.size() == left.size());
  CHECK(p.velocity.size() == left.size());
  CHECK(count_particles(s, "") == std::int64_t(left.size()));
  CHECK(p.in_obstacles == std::vector<std::size_t>{500 - left.size()});
  double worst = 0;
  for (std::size_t i = 0; i < left.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      worst = std::max(worst, std::fabs(p.position[i][k] - left[i][k]));
  CHECK(worst < 1e-12);
}

}  // namespace

TEST_CASE("emission: what is in an obstacle or nearer than 0.4 spacings is left out, in order") {
  check_left(
      with_obstacle("shape: sphere, center: [0.5, 0.4, 0.3], radius: 0.234"),
      [](const Double3& x) { return std::hypot(x[0] - 0.5, x[1] - 0.4, x[2] - 0.3) - 0.234; });
  check_left(with_obstacle("shape: plane, point: [0.31, 0, 0], normal: [2, 0, 0]"),
             [](const Double3& x) { return x[0] - 0.31; });
  check_left(with_obstacle("shape: box, min: [0.33, 0.2, -1], max: [0.62, 0.57, 0.3]"),
             [](const Double3& x) {
               const double a = std::max({0.33 - x[0], x[0] - 0.62, 0.0}),
                            b = std::max({0.2 - x[1], x[1] - 0.57, 0.0}),
                            c = std::max(x[2] - 0.3, 0.0);
               return std::sqrt(a * a + b * b + c * c);
             });
  check_left(with_obstacle("shape: capsule, from: [0.5, 0.3, 0.2], to: [0.5, 0.8, 0.2], "
                           "radius: 0.21"),
             [](const Double3& x) {
               const double y = x[1] - std::clamp(x[1], 0.3, 0.8);
               return std::hypot(x[0] - 0.5, y, x[2] - 0.2) - 0.21;
             });
}

TEST_CASE("emission: each body's share is told, and an obstacle without particles takes none") {
  Scene s = with_obstacle("shape: box, min: [0, 0, 0], max: [1, 1, 0.3]");
  s.bodies.push_back(s.bodies[0]);
  s.bodies[1].min[2] = 0.5, s.bodies[1].max[2] = 0.7;
  s.bodies[1].velocity = {1, 2, 3};
  Body random = s.bodies[0];
  random.shape = Shape::random_box;
  random.count = 1000;
  s.bodies.push_back(random);
  const Particles p = emit_particles(s, "");
  REQUIRE(p.in_obstacles.size() == 3);
  CHECK(p.in_obstacles[0] == 300);
  CHECK(p.in_obstacles[1] == 0);
  CHECK(p.in_obstacles[2] == Approx(680).margin(60));  // 0.34 of 0.5 m
  CHECK(p.size() == 200 + 200 + 1000 - p.in_obstacles[2]);
  CHECK(count_particles(s, "") == std::int64_t(p.size()));
  CHECK(p.velocity[199] == Double3{0, 0, 0});
  CHECK(p.velocity[200] == Double3{1, 2, 3});
  CHECK(p.velocity[399] == Double3{1, 2, 3});
  s.obstacles.clear();
  CHECK(emit_particles(s, "").in_obstacles.empty());
}

TEST_CASE(
    "emission: particles of a file that are in an obstacle are left out with their velocity") {
  const Folder folder;
  folder.write("p.csv",
               "x,y,z,vx,vy,vz\n0.5,0.5,0.5,1,0,0\n0.5,0.5,0.8,0,2,0\n0.5,0.5,0.4,0,0,3\n");
  Scene s = with_obstacle("shape: sphere, center: [0.5, 0.5, 0.45], radius: 0.1");
  s.bodies[0] = Body{};
  s.bodies[0].shape = Shape::file;
  s.bodies[0].path = "p.csv";
  const Particles p = emit_particles(s, folder.path.string());
  REQUIRE(p.size() == 1);
  CHECK(p.position[0] == Double3{0.5, 0.5, 0.8});
  CHECK(p.velocity[0] == Double3{0, 2, 0});
  CHECK(p.in_obstacles == std::vector<std::size_t>{2});
  CHECK(count_particles(s, folder.path.string()) == 1);
}

TEST_CASE("emission: bodies all in obstacles are an error that says so") {
  const Scene s = with_obstacle("shape: box, min: [-1, -1, -1], max: [2, 2, 0.45]");
  for (const auto& e :
       {error_of([&] { count_particles(s, ""); }), error_of([&] { emit_particles(s, ""); })})
    CHECK(e ==
          "2 bodies: the scene has 0 particles outside the obstacles; move the bodies or the "
          "obstacles");
}

TEST_CASE("emission: in two dimensions an obstacle's section counts, whatever its y") {
  const std::vector<std::string> flat{"dimensions=2", "domain.max=[1, 0.1, 1]"};
  for (const char* y : {"0.05", "0", "7"}) {
    const Scene s = with_obstacle(
        "shape: sphere, center: [0.5, " + std::string(y) + ", 0.2], radius: 0.2", flat);
    std::size_t left = 0;
    for (double z = 0; z < 5; ++z)
      for (double x = 0; x < 10; ++x)
        left += std::hypot(0.1 * (x + 0.5) - 0.5, 0.1 * (z + 0.5) - 0.2) - 0.2 >= 0.04;
    const Particles p = emit_particles(s, "");
    CHECK(p.size() == left);
    CHECK(p.in_obstacles == std::vector<std::size_t>{50 - left});
  }
}

}  // namespace pbf::scene_test
