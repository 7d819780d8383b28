// What is told of the ways of obstacles before a run: likely mistakes, and nothing of what is
// usual.
#include "lib/run/motion_warnings.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "lib/run/load_run.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// d = 0.1 m, h = 0.2 m, a box of 1 m, 1 s; gravity along -z.
Scene with(const std::string& obstacles, const std::string& more = "",
           const std::vector<std::string>& set = {}) {
  return parse(kMinimal + "obstacles: [" + obstacles + "]\n" + more, set);
}
const std::vector<std::string> kSlab{"dimensions=2", "domain.max=[1, 0.1, 1]"};
const std::string kBall = "{name: ball, shape: sphere, center: [0.5, 0.5, 0.6], radius: 0.15";

std::string moving_ball(const std::string& motion) { return kBall + ", motion: " + motion + "}"; }

MotionTable rows(std::vector<double> time, std::vector<std::array<double, 6>> values) {
  std::vector<std::int64_t> line;
  for (std::size_t k = 0; k < time.size(); ++k) line.push_back(std::int64_t(k) + 2);
  return {"/far/fall.csv", "", 3, std::move(time), std::move(values), std::move(line)};
}
Scene by_table(MotionTable table, const std::string& obstacle = kBall) {
  Scene s = with(obstacle + ", motion: {kind: file, path: fall.csv}}");
  s.obstacles[0].motion->table = std::move(table);
  return s;
}

std::string walls(const Scene& s) { return walls_text(s, tracks_of(s)); }
std::string collisions(const Scene& s) { return collisions_text(s, tracks_of(s)); }

/// A sine of amplitude 0.2 m at so many rows of each of two periods of 1 s.
MotionTable sampled(int rows_of_period, double shift) {
  std::vector<double> time;
  std::vector<std::array<double, 6>> values;
  for (int k = 0; k <= 2 * rows_of_period; ++k) {
    const double t = double(k) / rows_of_period;
    time.push_back(t);
    values.push_back({0.2 * std::sin(2 * 3.14159265358979 * (t + shift)), 0, 0});
  }
  return rows(time, values);
}

}  // namespace

TEST_CASE("tables: a curve that swings beyond a stop is told with rows, lines and by how much") {
  const std::string text = tables_text(
      by_table(rows({0, 0.1, 0.2, 0.26, 10},
                    {{}, {0, 0, -0.049}, {0, 0, -0.196}, {0, 0, -0.33}, {0, 0, -0.33}})));
  CHECK(contains(text,
                 "obstacles[0] (ball): its smooth curve swings beyond the rows of the table: "
                 "z goes to -0.3"));
  CHECK(contains(text,
                 " m beyond the -0.33 of the rows at 0.26 and 10 s (fall.csv, lines 5 and "
                 "6); give more rows: every few steps, and a second one just after a stop"));
}

TEST_CASE("tables: the remedy works, a second row just after the stop and just before a start") {
  CHECK(tables_text(by_table(rows({0, 0.1, 0.2, 0.29, 0.3, 0.301, 10}, {{},
                                                                        {0, 0, -0.049},
                                                                        {0, 0, -0.196},
                                                                        {0, 0, -0.4125},
                                                                        {0, 0, -0.4415},
                                                                        {0, 0, -0.4415},
                                                                        {0, 0, -0.4415}}))) == "");
  // A gate that would go down before it rises.
  CHECK(contains(tables_text(by_table(rows({0, 0.5, 0.6, 0.601, 9},
                                           {{}, {}, {0, 0, 0.3}, {0, 0, 0.3}, {0, 0, 0.3}}))),
                 "beyond the 0 of the rows at 0 and 0.5 s"));
  CHECK(tables_text(by_table(rows({0, 0.499, 0.5, 0.6, 0.601, 9},
                                  {{}, {}, {}, {0, 0, 0.3}, {0, 0, 0.3}, {0, 0, 0.3}}))) == "");
}

TEST_CASE("tables: crests of a smooth motion are no mistake, however its rows lie in them") {
  for (const int n : {8, 12, 20, 100})
    for (const double shift : {0.0, 0.01, 0.03, 0.05, 0.0625}) {
      CAPTURE(n, shift);
      CHECK(tables_text(by_table(sampled(n, shift))) == "");
    }
}

TEST_CASE("tables: what the run does not reach, and what is small, is not told") {
  const auto stop = [](double way) {
    return rows({0, 0.9, 1.2, 10}, {{}, {}, {way, 0, 0}, {way, 0, 0}});
  };
  Scene s = by_table(stop(0.5));
  CHECK(contains(tables_text(s), "at 0 and 0.9 s"));  // the stop comes after the end
  s.time.end = 5;
  CHECK(contains(tables_text(s), "at 1.2 and 10 s"));
  s.time.end = 0.05;
  CHECK(tables_text(s) == "");
  CHECK(tables_text(by_table(stop(0.04))) == "");
  s.time.end = 0.5, s.time.motion_begin = 3;
  CHECK(contains(tables_text(s), "at 1.2 and 10 s"));
}

TEST_CASE("tables: places that were given for displacements are told") {
  const MotionTable places = rows({0, 1}, {{0.5, 0.5, 0.6}, {0.5, 0.5, 0.5}});
  CHECK(contains(tables_text(by_table(places)),
                 "obstacles[0] (ball) is 0.927 m away from its place in the scene at the first row "
                 "of its table (fall.csv): x, y, z there count from that place; begin with 0,0,0"));
  CHECK(tables_text(by_table(rows({0, 1}, {{0.05}, {0.05}}))) == "");
  Scene goes_on = by_table(places);  // from a state of another run
  goes_on.time.motion_begin = 0.5, goes_on.time.end = 0.4;
  CHECK(tables_text(goes_on) == "");
}

TEST_CASE("tables: rotations count by how far they move the obstacle, the tank's by its size") {
  MotionTable t = rows({0, 0.1, 5}, {{}, {0, 0, 0, 0, 30, 0}, {0, 0, 0, 0, 30, 0}});
  t.columns = 6;
  CHECK(contains(tables_text(by_table(t)), "ry goes to 3"));
  CHECK(contains(tables_text(by_table(t)), " degrees beyond the 30 of the rows"));
  t.values[1][4] = t.values[2][4] = 0.5;
  CHECK(tables_text(by_table(t)) == "");
  Scene tank = parse(kMinimal + "tank_motion: {kind: file, path: t.csv, axis: [0, 1, 0]}\n");
  tank.tank_motion->table = rows({0, 0.1, 5}, {{}, {20}, {20}});
  tank.tank_motion->table.columns = 1;
  CHECK(contains(tables_text(tank), "tank_motion: its smooth curve swings beyond"));
  tank.tank_motion->table.columns = 3;  // accelerations are straight between rows
  CHECK(tables_text(tank) == "");
}

TEST_CASE("walls: a motion through a wall is told with its name, time and depth") {
  // Touches the floor after 0.45 s, goes on for 0.55 s.
  const std::string text = walls(with(moving_ball("{kind: velocity, velocity: [0, 0, -1]}")));
  CHECK(text ==
        "obstacles[0] (ball) goes through the wall z_min from 0.45 s on, by up to 0.55 m (at 1 s); "
        "end the run earlier, or give a table that stops it (motion: {kind: file})");
  CHECK(contains(
      walls(with(moving_ball("{kind: sine, direction: [1, 0, 0], amplitude: 0.5, period: 0.8}"))),
      "(ball) goes through the wall x_m"));
  const Scene fall = by_table(rows({0, 0.2, 10}, {{}, {0, 0, -0.6}, {0, 0, -0.6}}));
  CHECK(contains(walls(fall), "goes through the wall z_min"));
  CHECK(contains(walls(fall), "change the rows of its table"));
}

TEST_CASE("walls: what stops at a wall, or goes through an open face or the top, is usual") {
  CHECK(walls(with(moving_ball("{kind: velocity, velocity: [0, 0, -0.45]}"))) == "");
  CHECK(walls(with(moving_ball("{kind: velocity, velocity: [0, 0, -0.53]}"))) ==
        "");  // less than d
  CHECK(walls(with(moving_ball("{kind: velocity, velocity: [0, 0, 3]}"))) == "");
  CHECK(walls(with(moving_ball("{kind: velocity, velocity: [3, 0, 0]}"))) != "");
  CHECK(walls(with(moving_ball("{kind: velocity, velocity: [3, 0, 0]}"),
                   "domain.open: [x_max]\n")) == "");
  // The top is where gravity does not point.
  CHECK(walls(with(moving_ball("{kind: velocity, velocity: [0, 0, 3]}"),
                   "gravity: [0, 0, 9.81]\n")) != "");
  CHECK(walls(with(moving_ball("{kind: velocity, velocity: [0, 0, 3]}"), "gravity: [0, 0, 0]\n")) !=
        "");
}

TEST_CASE("walls: a paddle that goes on behind a wall moves in it, and is told where it is gone") {
  const std::string paddle =
      "{name: paddle, shape: box, min: [-0.3, -1, -1], max: [0.2, 2, 2], motion: {kind: sine, "
      "direction: [1, 0, 0], period: 0.7, amplitude: ";
  CHECK(walls(with(paddle + "0.15}}")) == "");
  CHECK(contains(walls(with(paddle + "0.5}}")),
                 "obstacles[0] (paddle) leaves the tank through the wall x_min at 0.3958 s"));
}

TEST_CASE("walls: a flap turns about a hinge at the floor, a blade must not reach the wall") {
  CHECK(walls(with("{name: flap, shape: box, min: [0.3, 0, 0], max: [0.7, 1, 0.4], motion: {kind: "
                   "sine, axis: [0, 1, 0], pivot: [0.5, 0, 0], amplitude: 40, period: 1}}")) == "");
  const auto blade = [](const std::string& half) {
    return "{name: blade, shape: box, center: [0.5, 0.5, 0.5], size: [0.1, " + half +
           ", 0.2], motion: {kind: velocity, angular: [0, 0, 360]}}";
  };
  CHECK(walls(with(blade("0.9"))) == "");
  // Its corners go behind the walls by less than a spacing.
  CHECK(walls(with("{name: blade, shape: box, min: [0.1, 0.1, 0.4], max: [0.9, 0.9, 0.6], motion: "
                   "{kind: velocity, angular: [0, 0, 360]}}")) == "");
  CHECK(contains(walls(with("{name: blade, shape: box, min: [0, 0.02, 0.4], max: [1, 0.98, 0.6], "
                            "motion: {kind: velocity, angular: [0, 0, 90]}}")),
                 "make the obstacle shorter"));
}

TEST_CASE("walls: in two dimensions nothing is said of y, and of a plane nothing at all") {
  Scene s = with(
      "{name: ball, shape: sphere, center: [0.5, 5, 0.6], radius: 0.2, motion: {kind: "
      "velocity, velocity: [0.1, 0, 0]}}",
      "", kSlab);
  CHECK(walls(s) == "");
  CHECK(walls(with("{name: piston, shape: plane, point: [0.1, 0, 0], normal: [1, 0, 0], motion: "
                   "{kind: velocity, velocity: [-3, 0, 0]}}")) == "");
}

TEST_CASE("collisions: obstacles that overlap at the start are told with how far") {
  const std::string box = "{name: box, shape: box, min: [0.5, 0, 0], max: [0.9, 1, 0.7]}";
  CHECK(contains(collisions(with(kBall + "}, " + box)),
                 "obstacles[0] (ball) and obstacles[1] (box) overlap by 0.15 m at the start; fluid "
                 "beside the place feels both"));
  CHECK(collisions(with("{name: a, shape: box, min: [0, 0, 0], max: [0.5, 1, 0.3]}, " + box)) ==
        "");
  CHECK(collisions(with("{name: a, shape: box, min: [0, 0, 0], max: [0.54, 1, 0.3]}, " + box)) ==
        "");
  CHECK(collisions(with("{name: a, shape: box, min: [0, 0, 0], max: [0.56, 1, 0.3]}, " + box)) !=
        "");
  // A slope is a plane, and what stands on it is set into it.
  CHECK(collisions(with("{name: slope, shape: plane, point: [0, 0, 0.2], normal: [-0.2, 0, 1]}, " +
                        box)) == "");
  // Beyond the walls obstacles may do what they like.
  CHECK(
      collisions(with("{name: a, shape: box, min: [-2, 0, 0], max: [0.2, 1, 1]}, {name: b, shape: "
                      "box, min: [-2, 0, -3], max: [-0.1, 1, 2]}")) == "");
}

TEST_CASE("collisions: those that run into each other are told with the time") {
  const std::string post = ", {name: post, shape: box, min: [0.8, 0, 0], max: [0.9, 1, 1]}";
  // 0.15 m are between them.
  CHECK(contains(collisions(with(moving_ball("{kind: velocity, velocity: [0.3, 0, 0]}") + post)),
                 "obstacles[0] (ball) and obstacles[1] (post) run into each other at 0.6"));
  CHECK(collisions(with(moving_ball("{kind: velocity, velocity: [0.15, 0, 0]}") + post)) == "");
  // Two that move alike keep their distance.
  const std::string both = "motion: {kind: velocity, velocity: [2, 0, 0]}}";
  CHECK(collisions(with(kBall + ", " + both +
                        ", {name: b, shape: sphere, center: [0.85, 0.5, 0.6], "
                        "radius: 0.15, " +
                        both)) == "");
  // Through a thin plate, within a hundredth of the run.
  CHECK(collisions(with(moving_ball("{kind: velocity, velocity: [90, 0, 0]}") +
                        ", {name: plate, shape: box, min: [0.8, 0, 0], max: [0.86, 1, 1]}")) != "");
  // Into the slope.
  CHECK(contains(
      collisions(with(moving_ball("{kind: velocity, velocity: [0, 0, -0.4]}") +
                      ", {name: bed, shape: plane, point: [0, 0, 0.2], normal: [0, 0, 1]}")),
      "and obstacles[1] (bed) run into each other"));
}

TEST_CASE("collisions: of many, three are named and the others counted") {
  std::string all;
  for (int k = 0; k < 4; ++k)
    all += (k ? ", " : "") + std::string("{name: b") + std::to_string(k) +
           ", shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.2}";
  CHECK(contains(collisions(with(all)), "; and 3 more; fluid"));
}

TEST_CASE("shared places: as thick as the largest ball in them, of all shapes") {
  const auto thick = [](const std::string& obstacles, const std::vector<std::string>& set = {}) {
    const Scene s = with(obstacles, "", set);
    return s.h() * shared_thickness(s, solid_at(s, s.obstacles[0], 0),
                                    solid_at(s, s.obstacles[1], 0), 1e-3);
  };
  const auto sphere = [](const std::string& at, const std::string& r) {
    return "{name: s" + at.substr(1, 3) + ", shape: sphere, center: " + at + ", radius: " + r + "}";
  };
  CHECK(thick(sphere("[0.3, 0.5, 0.5]", "0.25") + ", " + sphere("[0.6, 0.5, 0.5]", "0.2")) ==
        Approx(0.15).epsilon(1e-3));
  CHECK(thick(sphere("[0.3, 0.5, 0.5]", "0.2") + ", " + sphere("[0.8, 0.5, 0.5]", "0.2")) == 0);
  const std::string turned =
      "{name: b, shape: box, center: [0.5, 0.5, 0.5], size: [0.2, 0.3, 0.6], turn_axis: [1, 2, 3], "
      "turn_angle: 30}";
  CHECK(thick(turned + ", {name: c, shape: capsule, from: [-1, 0.5, 0.5], to: [2, 0.5, 0.5], "
                       "radius: 0.4}") == Approx(0.2).epsilon(1e-2));  // the box is the thinner one
  CHECK(thick(turned + ", {name: p, shape: plane, point: [0.5, 0.5, 0.5], normal: [0, 0, 1]}") ==
        Approx(0.2).epsilon(0.05));
  CHECK(
      thick("{name: c, shape: cylinder, from: [0.5, 0.5, 0], to: [0.5, 0.5, 1], radius: 0.2}, "
            "{name: d, shape: cylinder, from: [0.5, 0.5, 0.7], to: [0.5, 0.5, 2], radius: 0.3}") ==
      Approx(0.4).epsilon(1e-2));  // both go on behind the top
  CHECK(thick("{name: a, shape: sphere, center: [0.4, 0, 0.5], radius: 0.25}, {name: b, shape: "
              "sphere, center: [0.7, 9, 0.5], radius: 0.25}",
              kSlab) == Approx(0.2).epsilon(1e-3));
}

TEST_CASE("the scenes that come with the program say nothing of the ways of their obstacles") {
  namespace fs = std::filesystem;
  for (const auto& entry : fs::recursive_directory_iterator(PBF_SOURCE_DIR "/configs")) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".yaml" || contains(path, "/configs/study/") ||
        contains(path, "stability.yaml"))
      continue;
    CAPTURE(path);
    const Scene s = load_scene_or_run(path, {}).scene;
    CHECK(tables_text(s) + walls(s) + collisions(s) == "");
  }
}

}  // namespace pbf::scene_test
