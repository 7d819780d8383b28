// Shorter ways to write values give the scene that the long way gives.
#include "lib/scene/shorthand.h"

#include <algorithm>
#include <cmath>

#include "lib/scene/auto_step.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

const std::string kFlatText =
    "dimensions: 2\ndomain: {min: [0, 0], max: [2, 1]}\nfluid: {spacing: 0.05}\n"
    "bodies:\n  - {shape: block, min: [0, 0], max: [0.5, 0.5]}\ntime: {step: 0.002, end: 1}\n";

struct ShortForm {
  std::string text, message;
};

std::string without_size(const std::string& name, const std::string& rest) {
  return "obstacles: [{name: a, shape: " + name + ", " + rest + "}]\n";
}

}  // namespace

TEST_CASE("two dimensions: two numbers for vectors, and one spacing of thickness") {
  const Scene s =
      parse(kFlatText + "gravity: [0, -9.81]\n" +
            "obstacles:\n"
            "  - {name: a, shape: box, min: [1, 0], max: [1.2, 0.3], motion: {kind: "
            "velocity, velocity: [0.1, 0]}}\n"
            "  - {name: b, shape: cylinder, from: [0.8, 0.5], to: [0.8, 0.5], radius: "
            "0.2}\n"
            "  - {name: c, shape: capsule, from: [1.4, 0.5], to: [1.6, 0.5], radius: "
            "0.2}\n"
            "  - {name: d, shape: plane, point: [1.9, 0], normal: [-1, 1]}\n"
            "  - {name: e, shape: sphere, center: [0.7, 0.8], radius: 0.1}\n"
            "gauges:\n"
            "  - {name: h, kind: level, at: [0.3]}\n"
            "  - {name: u, kind: velocity, at: [0.3, 0.2]}\n"
            "  - {name: q, kind: flow, center: [0.5, 0.5], normal: [1, 0], size: [1]}\n");
  CHECK(s.domain.min == Double3{0, 0, 0});
  CHECK(s.domain.max == Double3{2, 0.05, 1});
  CHECK(s.bodies[0].max == Double3{0.5, 0.05, 0.5});
  CHECK(s.gravity == Double3{0, 0, -9.81});
  CHECK(s.obstacles[0].as<obstacle_keys::Box>().min == Double3{1, 0, 0});
  CHECK(s.obstacles[0].motion->velocity == Double3{0.1, 0, 0});
  CHECK(s.obstacles[1].as<obstacle_keys::Cylinder>().to == Double3{0.8, 0.05, 0.5});
  CHECK(s.obstacles[2].as<obstacle_keys::Capsule>().from == Double3{1.4, 0.025, 0.5});
  CHECK(s.obstacles[3].as<obstacle_keys::Plane>().normal == Double3{-1, 0, 1});
  CHECK(s.obstacles[4].as<obstacle_keys::Sphere>().center == Double3{0.7, 0.025, 0.8});
  CHECK(std::get<gauge_keys::Level>(s.gauges[0].kind).at == std::vector<double>{0.3});
  CHECK(std::get<gauge_keys::Velocity>(s.gauges[1].kind).at ==
        std::vector<double>{0.3, 0.025, 0.2});
  CHECK(std::get<gauge_keys::Flow>(s.gauges[2].kind).normal == Double3{1, 0, 0});
  CHECK(parse(resolved_yaml(s)) == s);
  CHECK(contains(resolved_yaml(s), "max: [2, 0.05, 1]"));
}

TEST_CASE("two dimensions: what has three numbers keeps them, and the rest follows it") {
  Scene s = parse(kFlatText, {"domain.min=[0, -0.1, 0]"});
  CHECK(s.domain.max == Double3{2, -0.1 + 0.05, 1});
  CHECK(s.bodies[0].min == Double3{0, -0.1, 0});
  s = parse(kFlatText, {"domain.max=[2, 0.08, 1]", "bodies[0].velocity=[1, 2]"});
  CHECK(s.domain.min[1] == 0);
  CHECK(s.bodies[0].max[1] == 0.08);
  CHECK(s.bodies[0].velocity == Double3{1, 0, 2});
  CHECK(parse(kFlatText, {"fluid.spacing=0.02"}).domain.max[1] == 0.02);
}

TEST_CASE("two dimensions: two numbers are refused elsewhere") {
  CHECK(contains(parse_error(kFlatText, {"dimensions=3"}),
                 "domain.min: expected 3 numbers [x, y, z], got a list of 2; two, [x, z], do with "
                 "dimensions: 2"));
  CHECK(contains(parse_error(kFlatText, {"domain.max=[2]"}), "expected 3 numbers"));
  CHECK(contains(parse_error(kFlatText, {"bodies[0].max=[2, wide]"}),
                 "element 2: expected a number"));
  CHECK(contains(parse_error(kFlatText + "render: {camera: {target: [1, 1]}}\n"),
                 "render.camera.target: expected 3 numbers [x, y, z] or auto, got a list of 2"));
  CHECK(
      contains(parse_error(kFlatText, {"fluid.spacing=wide"}), "fluid.spacing: expected a number"));
  CHECK(contains(parse_error("dimensions: 2\ndomain: 5\nbodies: {}\nfluid: [1, 2]\n"), "domain"));
}

TEST_CASE("boxes: by center and size") {
  const Scene s = parse(with_bodies("[{shape: block, center: [0.5, 0.5, 0.25], size: [1, 1, 0.5]}, "
                                    "{shape: random_box, size: [0.5, 0.5, 0.25], center: [0.5, "
                                    "0.5, 0.75], count: 9}]") +
                        without_size("box", "center: [0.5, 0.5, 0.5], size: [0.2, 0.4, 1]"));
  CHECK(s.bodies[0].min == Double3{0, 0, 0});
  CHECK(s.bodies[0].max == Double3{1, 1, 0.5});
  CHECK(s.bodies[1].min == Double3{0.25, 0.25, 0.625});
  CHECK(s.obstacles[0].as<obstacle_keys::Box>().max == Double3{0.6, 0.7, 1});
  CHECK_FALSE(contains(resolved_yaml(s), "size: [1"));
  const Scene flat =
      parse(kFlatText, {"bodies=[{shape: block, center: [0.5, 0.25], size: [1, 0.5]}]"});
  CHECK(flat.bodies[0].max == Double3{1, 0.05, 0.5});
}

TEST_CASE("boxes: what is wrong with center and size") {
  const std::string at = "bodies[0].";
  const std::vector<ShortForm> cases{
      {"center: [0, 0, 0], size: [1, 1, 1], min: [0, 0, 0]",
       "3:50: bodies[0].size: is given beside min; give center and size, or min and max"},
      {"center: [0, 0, 0], max: [1, 1, 1]", "bodies[0].center: is given beside max"},
      {"center: [0.5, 0.5, 0.5]",
       "bodies[0].size: missing; a box is given by center and size, or by min and max, in m"},
      {"size: [1, 1, 1]", "bodies[0].center: missing; a box is given by"},
      {"center: [0, 0, 0], size: [1, 1, 0]", "bodies[0].size: element 2: \"0\" is out of range"},
      {"center: [0, 0, 0], size: [1, 1, -1]", "bodies[0].size: element 2: \"-1\" is out of range"},
      {"center: [0, 0], size: [1, 1, 1]", "bodies[0].center: expected 3 numbers [x, y, z], got"},
      {"center: 5, size: [1, 1, 1]", "bodies[0].center: expected a list of 1 to 3 numbers, got"},
      {"center: [0.5, 0.5, 1], size: [1, 1, 1]",
       "bodies[0].max: reaches z = 1.5, outside the domain"},
  };
  for (const ShortForm& c : cases) {
    const std::string error = parse_error(with_bodies("[{shape: block, " + c.text + "}]"));
    CAPTURE(c.text, error);
    CHECK(contains(error, c.message));
  }
  CHECK(
      contains(parse_error(kFlatText, {"bodies=[{shape: block, center: [0, 0, 0], size: [1, 1]}]"}),
               "size: has 2 numbers, and center 3; give both two, or both three"));
  CHECK(contains(parse_error(with_bodies("[{shape: sphere, center: [0.5, 0.5, 0.5], size: 1}]")),
                 "bodies[0].size: unknown key"));
  CHECK_FALSE(
      contains(parse_error(with_bodies("[{shape: box, center: [0.5, 0.5, 0.5], size: [1, 1, 1]}]")),
               "size"));
  CHECK(contains(parse_error(kMinimal + without_size("box", "center: [1, 1, 1]")),
                 "obstacles[0].size: missing"));
}

TEST_CASE("gravity: by its magnitude, and tilted") {
  const auto g = [](const std::string& value) {
    return parse(kMinimal + "gravity: " + value + "\n").gravity;
  };
  CHECK(g("9.81") == Double3{0, 0, -9.81});
  CHECK(g("0") == Double3{0, 0, 0});
  CHECK_FALSE(std::signbit(g("0")[2]));
  CHECK(g("{magnitude: 1.62}") == Double3{0, 0, -1.62});
  CHECK(g("{}") == Double3{0, 0, -9.81});
  CHECK(g("{magnitude: 2, tilt: 90, toward: y_min}") == Double3{0, -2, 0});
  const double tilt = 5 * (3.14159265358979323846 / 180);
  CHECK(g("{tilt: 5}") == Double3{9.81 * std::sin(tilt), 0, -9.81 * std::cos(tilt)});
  CHECK(g("{tilt: 5, toward: x_min}")[0] == -9.81 * std::sin(tilt));
  CHECK(contains(resolved_yaml(parse(kMinimal + "gravity: 2\n")), "\ngravity: [0, 0, -2]\n"));
  CHECK(parse(kMinimal, {"gravity=3"}).gravity == Double3{0, 0, -3});
  CHECK(parse(kMinimal + "gravity: {tilt: 5}\n", {"gravity.tilt=0"}).gravity[2] == -9.81);
}

TEST_CASE("gravity: what is wrong with its magnitude") {
  const std::vector<ShortForm> cases{
      {"-9.81",
       "6:10: gravity: is -9.81, and one number is its magnitude, straight down; write "
       "9.81, or the vector [0, 0, -9.81]"},
      {"1e300", "expected 3 numbers [x, y, z], got \"1e300\""},
      {"down", "expected 3 numbers [x, y, z], got \"down\""},
      {"{tlt: 5}", "6:11: gravity.tlt: unknown key, did you mean gravity.tilt?"},
      {"{tilt: 95}",
       "6:17: gravity.tilt: is 95, and gravity is tilted by 0 to 90 degrees from straight down; "
       "for one that points upward give the vector, [x, y, z]"},
      {"{tilt: 180}", "gravity.tilt: is 180, and gravity is tilted by 0 to 90 degrees"},
      {"{tilt: -5}", "for the other way give toward: x_min"},
      {"{tilt: -5, toward: y_min}", "for the other way give toward: y_max"},
      {"{tilt: 1e13}", "gravity.tilt: "},
      {"9.81 m/s2", "write the number without a unit, the key is in m/s^2: 9.81"},
      {"9.81 m/s^2", "write the number without a unit, the key is in m/s^2: 9.81"},
      {"off", "gravity: is off; write 0 for none"},
      {"{x: 0, z: -9.81}", "gravity.x: unknown key; a vector is a list, gravity: [x, y, z]"},
      {"1 g", "the key is in m/s^2: 9.80665"},
      {"0 0 -9.81", "expected 3 numbers [x, y, z], got \"0 0 -9.81\"; write [0, 0, -9.81]"},
      {"(0, 0, -9.81)", "; write [0, 0, -9.81]"},
      {"{magnitude: -1}", "gravity.magnitude: \"-1\" is out of range"},
      {"{toward: z_min}", "gravity.toward: \"z_min\" is not one of x_min, x_max, y_min, y_max"},
      {"{x: 0}", "gravity.x: unknown key"},
      {"{g: 9.81}", "gravity.g: unknown key, did you mean gravity.magnitude?"},
      {"{angle: 5}", "gravity.angle: unknown key, did you mean gravity.tilt?"},
      {"{gravty: 9.81}", "gravity.gravty: unknown key\n"},
  };
  for (const ShortForm& c : cases) {
    const std::string error = parse_error(kMinimal + "gravity: " + c.text + "\n");
    CAPTURE(c.text, error);
    CHECK(contains(error + "\n", c.message));
  }
  CHECK(contains(parse_error(kFlatText + "gravity: {tilt: 5, toward: y_max}\n"),
                 "with dimensions: 2 nothing moves along y"));
}

TEST_CASE("short forms: what is wrong with one hides nothing else of the file") {
  const std::string error = parse_error(
      with_bodies("[{shape: block, center: [0.5, 0.5], size: [1, 1, 1]}, {shape: block, min: [0, "
                  "0, 0], max: [2, 1, 1]}]") +
      "gravity: {tilt: x}\nsolver: {iterations: -1}\nvorticity: {epsilon: wide}\n" +
      without_size("box", "center: [1, 1, 1]"));
  CAPTURE(error);
  for (const char* part :
       {"bodies[0].center: expected 3 numbers", "gravity.tilt: expected a number, got \"x\"",
        "solver.iterations: \"-1\" is out of range", "vorticity.epsilon: expected a number",
        "bodies[1].max: reaches x = 2, outside the domain", "obstacles[0].size: missing"})
    CHECK(contains(error, part));
  // What stands in for them is not judged.
  for (const char* part : {"bodies[0].m", "obstacles[0].m", "inverted", "empty", "no particle"})
    CHECK_FALSE(contains(error, part));
  CHECK(std::count(error.begin(), error.end(), '\n') == 5);
  const std::string negative = parse_error(kMinimal + "gravity: -9.81\nnme: x\n");
  CHECK(contains(negative, "write 9.81"));
  CHECK(contains(negative, "nme: unknown key"));
  const std::string beside = parse_error(
      with_bodies("[{shape: block, size: [1, 1, 1], min: [0, 0, wide], max: [1, 1, 1]}]"));
  CHECK(contains(beside, "bodies[0].size: is given beside min"));
  CHECK(contains(beside, "bodies[0].min: element 2: expected a number"));
  CHECK_FALSE(
      contains(parse_error(kMinimal + "gravity: {tilt: x}\n", {"time.step=auto"}), "time.step"));
}

TEST_CASE("time.step: auto: by gravity, by the speed of bodies, and a whole part of a frame") {
  const std::vector<std::string> automatic{"time.step=auto"};
  const auto step = [&](std::vector<std::string> more) {
    more.insert(more.begin(), "time.step=auto");
    return parse(kMinimal, more).time.step;
  };
  const double rule = 0.03 * std::sqrt(0.2 / 9.81);  // h = 0.2 m
  CHECK(step({}) == 0.0042);
  CHECK(step({}) <= rule);
  CHECK(step({"time.end=7.7"}) == step({}));  // a run may be made longer
  CHECK(step({"output.every=3"}) == 3 / std::ceil(3 / rule));
  CHECK(step({"output.every=0.02"}) == 0.02 / 5);
  CHECK(step({"output.every=0.004"}) == 0.004);
  CHECK(step({"output.every=1e-3"}) == 1e-3);
  CHECK(step({"gravity=981"}) < 0.11 * rule);
  CHECK(step({"bodies[0].velocity=[0, 0, 100]"}) == 0.0004);
  CHECK(step({"gravity=0", "bodies[0].velocity=[3, 4, 0]"}) == 0.008);
  const Scene s = parse(kMinimal, automatic);
  CHECK(parse(resolved_yaml(s)) == s);
  CHECK_FALSE(contains(resolved_yaml(s), "step: auto"));
  CHECK(step_rule(s).longest() == step_rule(s).gravity);
}

TEST_CASE("time.step: auto: what it cannot choose by") {
  CHECK(contains(parse_error(kMinimal, {"time.step=auto", "gravity=0"}),
                 "time.step: auto goes by gravity, the velocities of bodies and motions, and there "
                 "are none; give a number"));
  const std::string error = parse_error(kMinimal, {"time.step=auto", "fluid.spacing=-1"});
  CHECK(contains(error, "fluid.spacing"));
  CHECK_FALSE(contains(error, "time.step"));
  CHECK(contains(parse_error(kMinimal, {"time.step=0"}), "time.step: \"0\" is out of range"));
  CHECK(contains(parse_error(kMinimal, {"time.step=automatic"}),
                 "expected a number or auto, got \"automatic\""));
}

}  // namespace pbf::scene_test
