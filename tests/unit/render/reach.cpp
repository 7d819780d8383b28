// How fast and how high fluid may get: closed forms, and the same answer for the same physics.
#include "lib/render/reach.h"

#include "lib/scene/vector3.h"
#include "tests/support/render_support.h"

using namespace pbf;
using namespace pbf_test;

namespace {

constexpr double kG = 9.81;

Body block(const Double3& min, const Double3& max, const Double3& velocity = {}) {
  Body b;
  b.min = min, b.max = max, b.velocity = velocity;
  return b;
}
Scene tank(const Double3& max, std::vector<Body> bodies) {
  Scene s;
  s.domain.max = max;
  s.bodies = std::move(bodies);
  return s;
}
Reach reach(const Scene& s, std::int64_t particles = 1) {
  const double g = length(s.gravity);
  return reach_of(s, g > 0 ? (-1 / g) * s.gravity : Double3{0, 0, 1}, particles);
}
double calm(const Scene& s) { return std::sqrt(2 * kG * 0.05 * s.fluid.spacing); }

}  // namespace

TEST_CASE("a dam's range is what its fall to the floor sets free", "[render]") {
  const Scene s = tank({1.6, 0.4, 1}, {block({0, 0, 0}, {0.4, 0.4, 0.8})});
  const double fall = 0.4 - 0.1;  // of the centre of mass
  CHECK(reach(s).speed == Approx(1.6 * std::sqrt(2 * kG * fall)).epsilon(1e-6));
  CHECK(reach(s).height == Approx(0.2 + 12 * fall).epsilon(1e-6));
  Scene up = s;  // the same, thrown at 3 m/s
  up.bodies[0].velocity = {0, 3, 0};
  CHECK(reach(up).speed == Approx(1.6 * std::sqrt(9 + 2 * kG * fall)).epsilon(1e-6));
  up.gravity = {0, 0, 0};
  CHECK(reach(up).speed == Approx(1.6 * 3));
  CHECK(std::isinf(reach(up).height));
  up.bodies[0].velocity = {};
  CHECK(reach(up).speed == 1);
}

TEST_CASE("a calm pool has the small range of its particles, and its height", "[render]") {
  Scene s = tank({0.8, 0.6, 5}, {block({0, 0, 0}, {0.8, 0.6, 0.37})});
  for (const double d : {0.02, 0.005}) {
    s.fluid.spacing = d;
    CHECK(reach(s).speed == Approx(calm(s)));
    CHECK(reach(s).height == Approx(0.37).epsilon(1e-3));
  }
  // Of two bodies side by side, and with obstacles in it, it is as calm.
  s.bodies = {block({0, 0, 0}, {0.31, 0.6, 0.37}), block({0.31, 0, 0}, {0.8, 0.6, 0.37})};
  CHECK(reach(s).speed == Approx(calm(s)));
  s.bodies = {block({0, 0, 0}, {0.8, 0.6, 0.37})};
  s.obstacles = {pbf_test::sphere_obstacle({0.3, 0.3, 0.2}, 0.15),
                 pbf_test::plane_obstacle({0.5, 0, 0}, {-1, 0, 2})};
  CHECK(reach(s).speed == Approx(calm(s)));
}

TEST_CASE("a drop that falls into a large pool has the range of its own fall", "[render]") {
  Scene s = tank({0.8, 0.8, 1.2}, {block({0, 0, 0}, {0.8, 0.8, 0.2})});
  Body drop;
  drop.shape = Shape::sphere, drop.center = {0.4, 0.4, 0.6}, drop.radius = 0.12;
  drop.velocity = {0, 0, -2};
  s.bodies.push_back(drop);
  const double ball = 4 * std::numbers::pi / 3 * std::pow(0.12, 3), pool = 0.128;
  const double rest = 0.5 * (ball + pool) / 0.64;
  const double arrives = std::sqrt(4 + 2 * kG * (0.6 - rest));
  CHECK(reach(s).speed == Approx(0.8 * arrives).epsilon(0.01));
  CHECK(reach(s).height > 0.72);
  s.bodies[1].radius = 0.02;  // less than a hundredth of the fluid: nearly calm
  CHECK(reach(s).speed < 0.5 * arrives);
}

TEST_CASE("obstacles take room and lift the fluid at rest", "[render]") {
  Scene s = tank({1, 1, 1}, {block({0, 0, 0}, {0.5, 1, 0.5})});
  s.obstacles = {pbf_test::box_obstacle({0.5, 0, 0}, {1, 1, 0.25})};
  const auto solids = solids_in_metres(s, 0);
  const StartVolume start(s, {0, 0, 1}, solids);
  // Half of the floor is free up to 0.25 m, all of it above.
  const Rest rest = start.at_rest(0.25);
  CHECK(rest.surface == Approx(0.375).epsilon(0.01));
  CHECK(rest.height == Approx((0.125 * 0.125 + 0.125 * 0.3125) / 0.25).epsilon(0.01));
  CHECK(start.at_rest(1e-9).surface < 0.01);
  CHECK(start.at_rest(99).surface == Approx(1));  // more than there is room
  const Parcel p = start.parcels(1)[0];
  CHECK(p.volume == Approx(0.25));
  CHECK(p.height == Approx(0.25));
  CHECK(p.top == Approx(0.5));
}

TEST_CASE("the volume of every shape of body is its own", "[render]") {
  Scene s = tank({2, 2, 2}, {});
  Body sphere, tube, random = block({0, 0, 0}, {1, 1, 1}), file;
  sphere.shape = Shape::sphere, sphere.center = {1, 1, 1}, sphere.radius = 0.5;
  tube.shape = Shape::cylinder, tube.from = {0.5, 1, 1}, tube.to = {1.5, 1.2, 1.4};
  tube.radius = 0.2;
  random.shape = Shape::random_box, random.count = 1000;
  file.shape = Shape::file;
  s.bodies = {sphere, tube, random, file};
  const std::vector<Solid<double>> none;
  const auto all = StartVolume(s, {0, 0, 1}, none).parcels(10'000'000);
  REQUIRE(all.size() == 4);
  const double pi = std::numbers::pi;
  CHECK(all[0].volume == Approx(4 * pi / 3 * 0.125).epsilon(0.01));
  CHECK(all[0].height == Approx(1));
  CHECK(all[1].volume == Approx(pi * 0.04 * std::sqrt(1 + 0.04 + 0.16)).epsilon(0.02));
  CHECK(all[1].height == Approx(1.2).epsilon(0.01));
  CHECK(all[2].volume == Approx(1000 * s.cell_volume()));
  CHECK(all[3].volume > 0);
  CHECK(all[3].height == Approx(1));
  s.dimensions = 2, s.domain.min[1] = 1, s.domain.max[1] = 1.02;
  tube.from = {1, 0, 1}, tube.to = {1, 2, 1};
  s.bodies = {sphere, tube};
  const auto flat = StartVolume(s, {0, 0, 1}, none).parcels(1);
  CHECK(flat[0].volume == Approx(pi * 0.25 * 0.02).epsilon(0.02));
  CHECK(flat[1].volume == Approx(pi * 0.04 * 0.02).epsilon(0.02));
}

TEST_CASE("size, place and the way down change nothing but the numbers", "[render]") {
  const Scene s = tank({1.6, 0.4, 1}, {block({0, 0, 0}, {0.4, 0.4, 0.8})});
  const Reach here = reach(s);
  for (const double k : {1e-6, 1e4}) {
    Scene big = s;
    for (Double3* x : {&big.domain.max, &big.bodies[0].max}) *x = k * *x;
    big.fluid.spacing *= k;
    CHECK(reach(big).speed == Approx(std::sqrt(k) * here.speed));
    CHECK(reach(big).height == Approx(k * here.height));
  }
  Scene far = s;
  const Double3 way{1e5, -3e5, 7e4};
  for (Double3* x : {&far.domain.min, &far.domain.max, &far.bodies[0].min, &far.bodies[0].max})
    *x = *x + way;
  CHECK(reach(far).speed == Approx(here.speed).epsilon(1e-5));
  CHECK(reach(far).height - way[2] == Approx(here.height).epsilon(1e-5));
  // Gravity along x: the block lies as a dam of 0.4 m width on the wall x = 0.
  Scene turned = tank({1, 0.4, 1.6}, {block({0, 0, 0}, {0.8, 0.4, 0.4})});
  turned.gravity = {-kG, 0, 0};
  CHECK(reach(turned).speed == Approx(here.speed));
  turned.gravity = {kG, 0, 0};  // upside down: it falls as a whole
  turned.bodies = {block({0.2, 0, 0}, {1, 0.4, 0.4})};
  CHECK(reach(turned).speed == Approx(here.speed));
  Scene flat = s;
  flat.dimensions = 2, flat.domain.max[1] = flat.bodies[0].max[1] = 0.02;
  CHECK(reach(flat).speed == Approx(here.speed).epsilon(1e-3));
}

TEST_CASE("tilted gravity lets a level pool slide", "[render]") {
  Scene s = tank({1, 0.4, 0.5}, {block({0, 0, 0}, {1, 0.4, 0.2})});
  const double tilt = 5 * std::numbers::pi / 180;
  s.gravity = {kG * std::sin(tilt), 0, -kG * std::cos(tilt)};
  // From level to the slope: rho g sin^2/cos L^2/24/H per mass, of small angles.
  const double energy = kG * tilt * tilt / 24 / 0.2;
  CHECK(reach(s).speed == Approx(1.6 * std::sqrt(2 * energy)).epsilon(0.05));
}

TEST_CASE("what moves sets the range of a calm pool: obstacles and the tank", "[render]") {
  Scene s = tank({0.8, 0.8, 2}, {block({0, 0, 0}, {0.8, 0.8, 0.2})});
  Obstacle blade = pbf_test::box_obstacle({0.1, 0.1, 0.1}, {0.2, 0.2, 0.15});
  blade.motion = Motion{};
  blade.motion->kind = MotionKind::velocity;
  blade.motion->velocity = {0.4, 0, 0};
  s.obstacles = {blade};
  CHECK(reach(s).speed == Approx(1.25 * 0.4).epsilon(0.01));
  CHECK(reach(s).height == Approx(0.2 + 0.5 * 0.64 / kG).epsilon(0.02));
  s.obstacles[0].motion->velocity = {0, 0, 0.4};  // it rises out of the pool, for a second
  CHECK(reach(s).height == Approx(0.55).epsilon(0.01));

  s.obstacles.clear();
  TankMotion sway;
  sway.direction = Double3{1, 0, 0};
  sway.amplitude = 0.02, sway.period = 1;
  s.tank_motion = sway;
  const double a = 0.02 * 4 * std::numbers::pi * std::numbers::pi;
  CHECK(reach(s).speed == Approx(std::sqrt(2 * a * 2)).epsilon(0.01));  // the longest side is 2 m
}

TEST_CASE("where fluid can leave it falls to the floor, with a lid it does not", "[render]") {
  Scene s = tank({0.4, 0.4, 1}, {block({0, 0, 0}, {0.4, 0.4, 0.8})});
  CHECK(reach(s).speed == Approx(calm(s)));
  s.domain.open = {"z_max"};
  CHECK(reach(s).speed == Approx(calm(s)));
  for (const char* face : {"x_min", "y_max", "z_min"}) {
    s.domain.open = {face};
    CHECK(reach(s).speed == Approx(1.6 * std::sqrt(2 * kG * 0.4)));
  }
}

TEST_CASE("the frame of a view ends above the fluid, in the direction that is up", "[render]") {
  Scene s = tank({1, 0.5, 5}, {block({0, 0, 0}, {1, 0.5, 0.4})});
  REQUIRE(view_of(s, 1).frame);
  CHECK((*view_of(s, 1).frame)[1][2] == Approx(0.42).epsilon(0.01));
  CHECK((*view_of(s, 1).frame)[1][0] == 1);
  s.gravity = {0, 0, kG};
  s.bodies = {block({0, 0, 4.6}, {1, 0.5, 5})};
  CHECK((*view_of(s, 1).frame)[0][2] == Approx(4.58).epsilon(0.01));
  CHECK((*view_of(s, 1).frame)[1][2] == 5);
  s.gravity = {};
  CHECK_FALSE(view_of(s, 1).frame);
  s.gravity = {0, 0, -kG}, s.domain.open = {"z_min"};
  CHECK_FALSE(view_of(s, 1).frame);
}
