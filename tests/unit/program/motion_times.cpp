// Times at which motions are looked at: nothing between them is faster.
#include "lib/program/motion_times.h"

#include <cmath>
#include <numbers>

#include "lib/program/motion.h"
#include "lib/program/motion_table.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

Scene moved(const std::string& motion) {
  return parse(kMinimal +
               "obstacles: [{name: a, shape: box, min: [0.2, 0.2, 0.1], max: [0.4, 0.6, "
               "0.3], motion: " +
               motion + "}]\n");
}

/// The same from differences at very many times.
double fastest_by_looking(const Scene& s, double from, double to, int looks = 400000) {
  double most = 0;
  const Obstacle& o = s.obstacles[0];
  const double dt = 1e-7;
  for (int k = 0; k <= looks; ++k) {
    const double t = from + (to - from) * k / looks;
    const Pose a = pose_of(s, o, t), b = pose_of(s, o, t + dt);
    double square = 0;
    for (std::size_t c = 0; c < 3; ++c) square += std::pow(b.shift[c] - a.shift[c], 2);
    most = std::max(most, std::sqrt(square) / dt);
  }
  return most;
}

}  // namespace

TEST_CASE("times of motions: a ramp that is far shorter than the period is not missed") {
  // Half of an amplitude within 4 ms of a period of 20 s: 0.5 pi/2/0.004 m/s.
  const Scene s = moved(
      "{kind: sine, direction: [1, 0, 0], amplitude: 0.5, period: 20, phase: 90, ramp: 0.004}");
  const double speed = 0.5 * std::numbers::pi / 2 / 0.004;
  CHECK(fastest_obstacle(s, 0, 1) == Approx(speed).epsilon(0.01));
  CHECK(fastest_obstacle(s, 0, 100) == Approx(speed).epsilon(0.01));
  CHECK(fastest_obstacle(s, 0.005, 1) < 0.2);
}

TEST_CASE("times of motions: a sine is as fast as it is, in windows of any length") {
  const Scene s = moved("{kind: sine, direction: [0, 0, 2], amplitude: 0.1, period: 0.01}");
  const double speed = 0.1 * 2 * std::numbers::pi / 0.01;
  // 50000 periods: a limited number of even looks would meet them all in one phase.
  for (const double to : {0.004, 0.01, 0.013, 40.96, 500.0})
    CHECK(fastest_obstacle(s, 0, to) == Approx(speed).epsilon(1e-3));
  // A quarter of a period in which it nearly stands.
  CHECK(fastest_obstacle(s, 0.0024, 0.0026) < 0.1 * speed);
  Scene late = s;
  late.time.motion_begin = 0.0025;
  CHECK(fastest_obstacle(late, 0, 0.0001) < 0.1 * speed);
  CHECK(fastest_obstacle(late, 0, 0.0026) == Approx(speed).epsilon(1e-3));
}

TEST_CASE("times of motions: the steepest place between two rows is found, wherever it is") {
  Scene s = moved("{kind: file, path: t.csv}");
  s.obstacles[0].motion->table = {
      "t.csv", "", 3, {0, 0.9, 1, 1.3, 5}, {{}, {0, 0.01}, {0.2, 0.1}, {0.21, 0.3}, {0.21, -0.3}},
      {}};
  for (const auto& [from, to] : std::vector<std::pair<double, double>>{
           {0, 5}, {0, 0.95}, {0.91, 0.99}, {1, 1.3}, {1.05, 1.1}, {2, 4.9}}) {
    CAPTURE(from, to);
    const double looked = fastest_by_looking(s, from, to);
    CHECK(fastest_obstacle(s, from, to) >= 0.99 * looked);
    CHECK(fastest_obstacle(s, from, to) <= 1.01 * looked);
  }
}

TEST_CASE("times of motions: a ramp of a billion periods takes no longer than one") {
  const Scene s =
      moved("{kind: sine, direction: [1, 0, 0], amplitude: 0.1, period: 1.0e-6, ramp: 1000}");
  CHECK(telling_times(s, *s.obstacles[0].motion, 0, 1e9).size() < 5000);
  const Scene long_run = moved("{kind: sine, direction: [1, 0, 0], amplitude: 1, period: 1.0e-12}");
  CHECK(telling_times(long_run, *long_run.obstacles[0].motion, 0, 1e9).size() < 100);
}

TEST_CASE("times of motions: they rise from the first to the last of the window") {
  Scene s = moved("{kind: sine, axis: [0, 0, 1], amplitude: 5, period: 0.7, phase: -40, ramp: 2}");
  s.time.motion_begin = -0.3;
  const std::vector<double> times = telling_times(s, *s.obstacles[0].motion, 0.25, 3);
  CHECK(times.front() == 0.25);
  CHECK(times.back() == 3);
  for (std::size_t k = 1; k < times.size(); ++k) CHECK(times[k] > times[k - 1]);
}

TEST_CASE("times of motions: a tank that is turned by a table is felt where its rows bend") {
  Scene s = parse(kMinimal + "tank_motion: {kind: file, path: t.csv, axis: [0, 1, 0]}\n");
  // A kick of 10 ms in the middle of a second: 2 degrees there and back.
  s.tank_motion->table = {
      "t.csv", "", 1, {0, 0.5, 0.505, 0.51, 0.511, 2}, {{0}, {0}, {2}, {0}, {0}, {0}}, {}};
  s.time.step = 1e-4;
  double most = 0;
  for (double t = 0.49; t < 0.52; t += 1e-5) most = std::max(most, greatest_sway(s, t, t));
  CHECK(greatest_sway(s, 0, 1) >= 0.99 * most);
  CHECK(greatest_sway(s, 0.2, 0.7) >= 0.99 * most);
  CHECK(greatest_sway(s, 0.8, 1) < 0.01 * most);
}

TEST_CASE("curves: a piece turns where its values do") {
  MotionTable t{"t.csv", "", 3, {0, 1, 2, 6}, {{0}, {1}, {1}, {1}}, {}};
  const CurvePiece p = curve_piece(t, 0, 1);
  const std::vector<double> turns = p.turns();
  REQUIRE(turns.size() == 1);  // it comes with a slope, and rests from the next row on
  CHECK(cubic(t, 0, turns[0]) > 1);
  CHECK(cubic(t, 0, turns[0]) >= cubic(t, 0, turns[0] - 1e-3));
  CHECK(cubic(t, 0, turns[0]) >= cubic(t, 0, turns[0] + 1e-3));
  CHECK(curve_piece(t, 0, 2).turns().empty());
  CHECK(curve_piece(t, 1, 0).turns().empty());  // a column of zeros
  CHECK(piece_at(t, -1) == 0);
  CHECK(piece_at(t, 1) == 1);
  CHECK(piece_at(t, 9) == 2);
}

}  // namespace pbf::scene_test
