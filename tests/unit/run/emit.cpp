// Bodies make the particles that their shape says, in the same order on every machine.
#include <algorithm>
#include <cmath>

#include "lib/run/emit.h"
#include "lib/scene/random.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

Scene unit_box(double spacing, std::vector<Body> bodies) {
  Scene s;
  s.fluid.spacing = spacing;
  s.bodies = std::move(bodies);
  return s;
}

Body block(Double3 min, Double3 max) {
  Body b;
  b.min = min;
  b.max = max;
  return b;
}

Body sphere(Double3 center, double radius) {
  Body b;
  b.shape = Shape::sphere;
  b.center = center;
  b.radius = radius;
  return b;
}

Body random_box(Double3 min, Double3 max, std::int64_t count, std::uint64_t seed) {
  Body b = block(min, max);
  b.shape = Shape::random_box;
  b.count = count;
  b.seed = seed;
  return b;
}

}  // namespace

TEST_CASE("block: cell centres, x fastest, exact positions") {
  const Particles p = emit_particles(unit_box(0.25, {block({0, 0.5, 0}, {0.5, 1, 0.75})}), "");
  REQUIRE(p.size() == 2 * 2 * 3);
  CHECK(p.velocity.size() == 12);
  CHECK(p.position[0] == Double3{0.125, 0.625, 0.125});
  CHECK(p.position[1] == Double3{0.375, 0.625, 0.125});
  CHECK(p.position[2] == Double3{0.125, 0.875, 0.125});
  CHECK(p.position[4] == Double3{0.125, 0.625, 0.375});
  CHECK(p.position[11] == Double3{0.375, 0.875, 0.625});
}

TEST_CASE("block: rounding of length over spacing neither adds nor loses a layer") {
  // 0.3 / 0.1 = 2.9999999999999996 and 0.6 / 0.2 = 2.9999999999999996 in binary.
  CHECK(count_particles(unit_box(0.1, {block({0, 0, 0}, {0.3, 0.3, 0.3})}), "") == 27);
  CHECK(count_particles(unit_box(0.1, {block({0.1, 0.1, 0.1}, {0.4, 0.7, 0.8})}), "") == 3 * 6 * 7);
  CHECK(count_particles(unit_box(0.1, {block({0, 0, 0}, {0.39, 0.1, 0.1})}), "") == 3);
  for (int n = 1; n <= 200; ++n) {
    const double d = 1.0 / n;
    CAPTURE(n);
    CHECK(count_particles(unit_box(d, {block({0, 0, 0}, {1, d, d})}), "") == n);
  }
}

TEST_CASE("sphere: the lattice points through its centre, by brute force") {
  for (double ratio : {0.5, 1.0, 1.5, 3.0, 4.7, 10.0}) {
    const double d = 0.04;
    const Scene s = unit_box(d, {sphere({0.5, 0.5, 0.5}, ratio * d)});
    std::int64_t expected = 0;
    for (int i = -11; i <= 11; ++i)
      for (int j = -11; j <= 11; ++j)
        for (int k = -11; k <= 11; ++k)
          expected += std::sqrt(double(i * i + j * j + k * k)) <= ratio * (1 + 1e-12);
    const Particles p = emit_particles(s, "");
    CAPTURE(ratio);
    CHECK(static_cast<std::int64_t>(p.size()) == expected);
    CHECK(count_particles(s, "") == expected);
    CHECK(std::find(p.position.begin(), p.position.end(), Double3{0.5, 0.5, 0.5}) !=
          p.position.end());
    for (const Double3& x : p.position)
      CHECK(std::hypot(x[0] - 0.5, x[1] - 0.5, x[2] - 0.5) <= ratio * d * (1 + 1e-9));
  }
}

TEST_CASE("SplitMix64: the published sequence") {
  SplitMix64 random(1234567);
  CHECK(random.next() == 6457827717110365317u);
  CHECK(random.next() == 3203168211198807973u);
  CHECK(random.next() == 9817491932198370423u);
  CHECK(random.next() == 4593380528125082431u);
  CHECK(random.next() == 16408922859458223821u);
}

TEST_CASE("random box: three draws per particle, values computed independently") {
  const Particles p = emit_particles(unit_box(0.1, {random_box({0, 0, 0}, {1, 1, 1}, 2, 1)}), "");
  REQUIRE(p.size() == 2);
  CHECK(p.position[0] == Double3{0.5665615751722809, 0.7457817572627011, 0.9710027535867962});
  CHECK(p.position[1] == Double3{0.4443592170557721, 0.44426470082635805, 0.762894391911761});
}

TEST_CASE("random box: uniform, inside, reproducible, and the seed matters") {
  const Body body = random_box({0.2, 0.4, 0.1}, {0.4, 0.5, 0.9}, 20000, 42);
  const Particles p = emit_particles(unit_box(0.1, {body}), "");
  CHECK(p.position == emit_particles(unit_box(0.1, {body}), "").position);
  Body other = body;
  other.seed = 43;
  CHECK(p.position != emit_particles(unit_box(0.1, {other}), "").position);
  for (int a = 0; a < 3; ++a) {
    const double edge = body.max[a] - body.min[a];
    double mean = 0, square = 0;
    for (const Double3& x : p.position) {
      REQUIRE(x[a] >= body.min[a]);
      REQUIRE(x[a] <= body.max[a]);
      const double u = (x[a] - body.min[a]) / edge;
      mean += u / 20000;
      square += u * u / 20000;
    }
    CHECK(mean == Approx(0.5).margin(0.01));  // 5 standard errors
    CHECK(square - mean * mean == Approx(1.0 / 12).margin(0.003));
  }
}

TEST_CASE("bodies: in the order of the list, each with its velocity") {
  Body first = block({0, 0, 0}, {0.2, 0.1, 0.1}), second = sphere({0.5, 0.5, 0.5}, 0.05);
  first.velocity = {1, 2, 3};
  second.velocity = {-1, 0, 0};
  const Particles p = emit_particles(unit_box(0.1, {first, second}), "");
  REQUIRE(p.size() == 3);
  CHECK(p.velocity[0] == Double3{1, 2, 3});
  CHECK(p.velocity[1] == Double3{1, 2, 3});
  CHECK(p.velocity[2] == Double3{-1, 0, 0});
  CHECK(p.position[2] == Double3{0.5, 0.5, 0.5});
}

TEST_CASE("emit: particles outside the domain are refused, those on it by rounding are put there") {
  const std::string error = error_of([] {
    emit_particles(
        unit_box(0.1, {block({0, 0, 0}, {0.1, 0.1, 0.1}), block({0, 0, 0}, {0.1, 0.1, 1.2})}), "");
  });
  CHECK(contains(error, "2 bodies[1]: particle 10 at [0.05, 0.05, 1.05"));
  CHECK(contains(error, "outside the domain along z (0 .. 1 m)"));
  Scene s = unit_box(0.1, {sphere({0.2, 0.2, 0.2}, 0.1)});
  s.domain.max = {0.3, 0.3, 0.3};  // 0.2 + 0.1 = 0.30000000000000004
  for (const Double3& x : emit_particles(s, "").position)
    for (double c : x) CHECK(c <= 0.3);
}

TEST_CASE("emit: no particles and too many are errors, before anything is allocated") {
  CHECK(contains(error_of([] { emit_particles(unit_box(0.1, {}), ""); }), "0 particles"));
  CHECK(contains(error_of([] {
                   emit_particles(unit_box(2, {block({0, 0, 0}, {1, 1, 1})}), "");
                 }),
                 "0 particles"));
  const auto tiny = [](const Body& body) {
    return error_of([&] { emit_particles(unit_box(1e-6, {body}), ""); });
  };
  CHECK(contains(tiny(block({0, 0, 0}, {1, 1, 1})), "2 bodies: the scene would have 1e+18 "));
  CHECK(contains(tiny(sphere({0.5, 0.5, 0.5}, 0.5)),
                 "5.24e+17 particles, at most 2147483647 are possible; raise fluid.spacing"));
}

TEST_CASE("in two dimensions every body is its cut with the middle of the domain's y") {
  Scene s = unit_box(0.1, {block({0, 0, 0}, {0.5, 1, 0.3}), sphere({0.7, 0.05, 0.7}, 0.25),
                           sphere({0.7, 0.2, 0.3}, 0.25), random_box({0, 0, 0}, {1, 1, 1}, 50, 3)});
  s.dimensions = 2;
  s.domain.max[1] = 0.1;
  const Particles p = emit_particles(s, "");
  // 15 of the rectangle, 21 of the disc of 2.5 d, 13 of that of 2 d (from 2.5 and 1.5 d off).
  REQUIRE(p.size() == 15 + 21 + 13 + 50);
  CHECK(count_particles(s, "") == 99);
  for (const Double3& x : p.position) CHECK(x[1] == 0.05);
  CHECK(p.position[0] == Double3{0.05, 0.05, 0.05});
  CHECK(p.position[5][2] == Approx(0.15));
  // Two draws for each particle of the random body, x and z.
  SplitMix64 random(3);
  CHECK(p.position[49][0] == random.uniform());
  CHECK(p.position[49][2] == random.uniform());
  CHECK(s.particle_mass() == Approx(1000 * 0.1 * 0.1 * 0.1));
  s.domain.max[1] = 0.15;
  CHECK(s.particle_mass() == Approx(1000 * 0.1 * 0.1 * 0.15));
}

TEST_CASE("in two dimensions particles of a file must lie in the slab and not move along y") {
  const Folder folder;
  const auto with = [&](const std::string& rows) {
    Body b;
    b.shape = Shape::file;
    b.path = folder.write("p.csv", "x,y,z,vx,vy,vz\n" + rows);
    Scene s = unit_box(0.1, {b});
    s.dimensions = 2;
    s.domain.max[1] = 0.1;
    return s;
  };
  const Particles p = emit_particles(with("0.5,0.02,0.5,1,0,2\n0.7,0.1,0.5,0,0,0\n"), "");
  CHECK(p.position[0] == Double3{0.5, 0.05, 0.5});
  CHECK(p.position[1][1] == 0.05);
  CHECK(p.velocity[0] == Double3{1, 0, 2});
  const auto error = [&](const std::string& row) {
    return error_of([&] { emit_particles(with(row), ""); });
  };
  CHECK(contains(error("0.5,0.2,0.5,0,0,0\n"), "the slab which holds all particles"));
  CHECK(contains(error("0.5,0.05,0.5,0,1,0\n"), "its y component must be 0"));
}

TEST_CASE("particles nearer to a wall than the margin start on it, those before it stay") {
  Scene s = unit_box(0.1, {block({0, 0, 0}, {0.3, 0.3, 0.3})});
  s.domain.max = {1, 1, 1};
  s.solver.wall_margin = 0.05;  // where the lattice is
  const Particles free = emit_particles(s, "");
  CHECK(free.put_on_margin == 0);
  CHECK(free.position[0][0] == Approx(0.05).epsilon(1e-12));
  s.solver.wall_margin = 0.08;
  const Particles p = emit_particles(s, "");
  CHECK(p.put_on_margin == 27 - 8);
  CHECK(p.farthest_put == Approx(0.03));
  REQUIRE(p.size() == free.size());
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      CHECK(p.position[i][a] == std::max(free.position[i][a], 0.08));
      CHECK(p.velocity[i][a] == 0);
    }
}

TEST_CASE("an open face has no margin") {
  Scene s = unit_box(0.1, {block({0, 0, 0}, {0.3, 0.1, 0.3})});
  s.domain.max = {1, 1, 1};
  s.domain.open = {"z_min", "y_min"};
  s.solver.wall_margin = 0.08;
  const Particles p = emit_particles(s, "");
  CHECK(p.put_on_margin == 3);  // a column along z and the plane x = 0.05
  for (const Double3& x : p.position) {
    CHECK(x[0] >= 0.08);
    CHECK(x[1] == Approx(0.05));
  }
}

TEST_CASE("a start that the margin would squeeze by more than half a spacing is refused") {
  Scene s = unit_box(0.1, {block({0, 0, 0}, {0.3, 0.3, 0.3})});
  s.domain.max = {1, 1, 1};
  s.solver.wall_margin = 0.12;
  const std::string error = error_of([&] { emit_particles(s, ""); });
  CHECK(contains(error,
                 "2 bodies[0]: 19 particles are nearer to a wall than solver.wall_margin "
                 "(0.12 m) by more than half of fluid.spacing, the farthest by 0.0"));
  s.bodies = {block({0.1, 0.1, 0.1}, {0.4, 0.4, 0.4})};  // where the margin leaves it alone
  CHECK(emit_particles(s, "").put_on_margin == 0);
}

}  // namespace pbf::scene_test
