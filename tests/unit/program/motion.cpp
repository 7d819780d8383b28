// Poses of obstacles and of the tank as functions of time.
#include "lib/program/motion.h"

#include <cmath>

#include "lib/program/obstacles.h"
#include "tests/support/catch.h"
#include "tests/support/obstacle_shapes.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

Scene with_motion(const std::string& motion, const std::string& more = "") {
  return parse(kMinimal +
               "obstacles: [{name: a, shape: box, min: [0.2, 0.2, 0.1], max: [0.4, 0.6, "
               "0.3], motion: " +
               motion + "}]\n" + more);
}
Double3 place(const Scene& s, const Double3& x, double time) {
  return pose_of(s, s.obstacles[0], time).of(x);
}
void check_near(const Double3& a, const Double3& b, double margin = 1e-12) {
  for (std::size_t k = 0; k < 3; ++k) CHECK(a[k] == Approx(b[k]).margin(margin));
}
MotionTable table(int columns, std::vector<double> time,
                  std::vector<std::array<double, 6>> values) {
  return {"t.csv", "", columns, std::move(time), std::move(values)};
}

}  // namespace

TEST_CASE("poses: a sine along a direction, with phase and ramp") {
  const Scene s = with_motion(
      "{kind: sine, direction: [3, 0, 4], amplitude: 0.5, period: 2, phase: 30, ramp: 4}");
  for (const double t : {-1.0, 0.0, 0.7, 2.0, 4.0, 5.5}) {
    const double ramp = t <= 0 ? 0 : t >= 4 ? 1 : (1 - std::cos(kPi * t / 4)) / 2;
    const double way = 0.5 * ramp * std::sin(kPi * t + kPi / 6);
    check_near(place(s, {1, 2, 3}, t), {1 + 0.6 * way, 2, 3 + 0.8 * way});
  }
}

TEST_CASE("poses: a sine about an axis turns about the middle, or the pivot") {
  const Scene s = with_motion("{kind: sine, axis: [0, 0, -2], amplitude: 90, period: 4}");
  check_near(place(s, {0.3, 0.4, 0.2}, 1), {0.3, 0.4, 0.2});
  check_near(place(s, {0.4, 0.4, 0.2}, 1), {0.3, 0.3, 0.2});
  const Scene p =
      with_motion("{kind: sine, axis: [0, 0, 1], amplitude: 90, period: 4, pivot: [0, 0, 0]}");
  check_near(place(p, {1, 0, 5}, 1), {0, 1, 5});
  // In the kernels' terms: centre and axes of the body, lengths in h (0.2 m).
  const Solid<double> o = solids_of(p, 1)[0];
  check_near({o.center.x, o.center.y, o.center.z}, {-2, 1.5, 1});
  CHECK(o.turn[0][0] == Approx(0).margin(1e-12));
  CHECK(o.turn[0][1] == Approx(1));
  CHECK(o.turn[1][0] == Approx(-1));
}

TEST_CASE("poses: a velocity and a turn go on from motion_begin") {
  const Scene s = with_motion(
      "{kind: velocity, velocity: [1, 0, -2], angular: [0, 90, 0], pivot: [0, 0, 0]}", "");
  check_near(place(s, {1, 5, 0}, 1), {1, 5, -3});
  Scene later = s;
  later.time.motion_begin = 1;
  check_near(place(later, {1, 5, 0}, 0), place(s, {1, 5, 0}, 1));
  CHECK(fastest_obstacle(s, 0, 1) > std::sqrt(5.0));
}

TEST_CASE(
    "poses: a table goes through its rows, with slopes that do not jump, and turns in order") {
  Scene s = with_motion("{kind: file, path: t.csv, pivot: [0, 0, 0]}");
  Motion& m = *s.obstacles[0].motion;
  m.table = table(6, {0, 1, 3}, {{0, 0, 0, 0, 0, 0}, {1, 0, 0, 90, 0, 90}, {-1, 2, 0, 0, 0, 0}});
  check_near(place(s, {0, 0, 0}, 3), {-1, 2, 0});
  check_near(place(s, {0, 1, 0}, 1), {1, 0, 1});  // about x first: onto z, which z leaves there
  const double e = 1e-6;
  for (const double t : {1.0, 2.0})
    check_near(place(s, {0, 0, 0}, t + e), place(s, {0, 0, 0}, t), 1e-5);
  const auto slope = [&](double t) { return (place(s, {}, t + e)[0] - place(s, {}, t)[0]) / e; };
  CHECK(slope(1 - e) == Approx(slope(1)).margin(1e-4));
  // A straight line stays one.
  m.table = table(3, {0, 0.1, 1}, {{0}, {0.1}, {1}});
  for (const double t : {0.03, 0.1, 0.5, 1.2}) CHECK(place(s, {0, 0, 0}, t)[0] == Approx(t));
}

TEST_CASE("poses: a motion from a file that was not read is an error, not a standstill") {
  const Scene s = with_motion("{kind: file, path: t.csv}");
  CHECK_THROWS_WITH(solids_of(s), "the motion in t.csv is not read");
}

TEST_CASE("poses: a box that leaves the wall it stood on has a face there") {
  Scene s = parse(kMinimal +
                  "obstacles: [{name: a, shape: box, min: [0.2, 0.2, 0], max: [0.4, 0.4, 0.3], "
                  "motion: {kind: velocity, velocity: [1, 0, 1]}}]\n");
  CHECK(pbf_test::through_of(solids_of(s, 0)[0]) == 16u);
  CHECK(pbf_test::through_of(solids_of(s, 0.1)[0]) == 0u);
}

TEST_CASE("a tank's step: gravity where it stands, turned with it, and what a turning tank adds") {
  Scene s = parse(kMinimal);
  const double dt = 1e-3;
  const FrameStep<double> still = frame_step(s, {}, 0, dt);
  CHECK(still.push.z == Approx(-9.81 * dt / 0.2));
  CHECK(still.pull[0][0] == 0);
  s.tank_motion.emplace();
  s.tank_motion->kind = TankMotionKind::file;
  s.tank_motion->axis = Double3{0, 1, 0};
  s.tank_motion->table = table(1, {0, 10}, {{0}, {900}});  // pi/2 per second
  const FrameStep<double> f = frame_step(s, {}, 1 - dt, dt);
  // At t = 1 the tank's x points along -z of the frame at rest.
  CHECK(f.push.x == Approx(9.81 * dt / 0.2));
  CHECK(f.push.z == Approx(0).margin(1e-9));
  const double w = kPi / 2;
  CHECK(f.pull[0][0] / dt == Approx(w * w).epsilon(1e-3));  // centrifugal
  CHECK(f.pull[1][1] == Approx(0).margin(1e-12));
  CHECK(f.turn[0][2] / dt == Approx(-2 * w).epsilon(1e-3));  // Coriolis: -2 w x v
  CHECK(f.turn[2][0] / dt == Approx(2 * w).epsilon(1e-3));
  const Axes axes{{2, 0, 1}};
  const FrameStep<double> other = frame_step(s, axes, 1 - dt, dt);
  CHECK(other.push.y == f.push.x);
  CHECK(other.turn[1][0] == f.turn[0][2]);
  CHECK(greatest_pull(s, 0, 1) > 9.81);
}

TEST_CASE(
    "poses: a jump between two rows close together swings beyond the table by less than a "
    "quarter") {
  Scene s = with_motion("{kind: file, path: t.csv}");
  // At rest for 0.1 s, then 0.4 m in 0.8 ms, at rest for 0.1 s.
  s.obstacles[0].motion->table =
      table(3, {0, 0.1, 0.1004, 0.1008, 0.2, 10}, {{}, {}, {0.2}, {0.4}, {0.4}, {0.4}});
  s.time.end = 1;
  double low = 0, high = 0;
  for (double t = 0; t < 1; t += 1e-5) {
    const double x = place(s, {}, t)[0];
    low = std::min(low, x), high = std::max(high, x);
  }
  CHECK(low > -0.05);
  CHECK(high < 0.45);
  CHECK(place(s, {}, 0.1004)[0] == Approx(0.2));
  // And it is seen, wherever the times are that are looked at.
  CHECK(fastest_obstacle(s, 0, 1) > 400);
  CHECK(fastest_obstacle(s, 0.05, 0.15) > 400);
  CHECK(fastest_obstacle(s, 0.25, 1) < 2);
}

}  // namespace pbf::scene_test
