// What a scene may say of free bodies, and every error about them with its remedy.
#include "lib/run/linked_files.h"
#include "lib/scene/difference.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// d = 0.1 m, h = 0.2 m, a box of 1 m.
std::string ball(const std::string& free, const std::string& center = "[0.5, 0.5, 0.5]") {
  return "{name: a, shape: sphere, center: " + center + ", radius: 0.2, free: " + free + "}";
}
Scene with_solids(const std::string& obstacles, const std::vector<std::string>& set = {}) {
  return parse(kMinimal + "obstacles: [" + obstacles + "]\n", set);
}
std::string solids_error(const std::string& obstacles, const std::vector<std::string>& set = {},
                         const std::string& more = "") {
  return parse_error(kMinimal + "obstacles: [" + obstacles + "]\n" + more, set);
}
const std::vector<std::string> kFlatBox{"dimensions=2", "domain.max=[1, 0.1, 1]"};
const std::string kHeavy = "{density: 500}";

}  // namespace

TEST_CASE("free bodies: all keys are read, also by --set, and written back") {
  const Scene s = with_solids(
      ball("{density: 998.2, lock: [x, ry], velocity: [0.1, -2, 3], angular: [0, 90, 1.0e-3]}"),
      {"obstacles[0].free.velocity=[1, 2, 3]"});
  const FreeBody& f = *s.obstacles[0].free;
  CHECK(f.density == 998.2);
  CHECK_FALSE(f.mass);
  CHECK(f.lock == std::vector<std::string>{"x", "ry"});
  CHECK(f.locks("ry"));
  CHECK_FALSE(f.locks("y"));
  CHECK(f.velocity == Double3{1, 2, 3});
  CHECK(f.angular == Double3{0, 90, 1e-3});
  CHECK(parse(resolved_yaml(s)) == s);
  CHECK(resolved_yaml(parse(resolved_yaml(s))) == resolved_yaml(s));
  const Scene by_mass = with_solids(ball("{mass: 2}"));
  CHECK(by_mass.obstacles[0].free->mass == 2.0);
  CHECK_FALSE(by_mass.obstacles[0].free->density);
  CHECK(by_mass.obstacles[0].free->lock.empty());
  CHECK(parse(resolved_yaml(by_mass)) == by_mass);
  CHECK_FALSE(with_solids(ball("off")).obstacles[0].free);
  Scene other = s;
  other.obstacles[0].free->density = 700;
  CHECK(physics_difference(s, other) == "obstacles[0].free.density: 998.2 before, 700 now");
  other.obstacles[0].free.reset();
  CHECK(physics_difference(s, other) == "obstacles[0].free: on before, off now");
  const Scene flat = with_solids(ball("{mass: 3, velocity: [1, 2]}", "[0.5, 0.5]"), kFlatBox);
  CHECK(flat.obstacles[0].free->velocity == Double3{1, 0, 2});
  CHECK(parse(resolved_yaml(flat)) == flat);
}

TEST_CASE("free bodies: exactly one of density and mass is given") {
  const std::string place = "2 scene.yaml:6:82: obstacles[0].free: ";
  CHECK(solids_error(ball("{density: 500, mass: 3}")) ==
        place + "a free body needs density or mass, not both; remove one");
  for (const char* none : {"{}", "on", "{lock: [x]}"})
    CHECK(solids_error(ball(none)) ==
          place + "a free body needs density (kg/m^3) or mass (kg); give one");
  CHECK(contains(solids_error(ball("{density: 0}")), "obstacles[0].free.density: "));
  CHECK(contains(solids_error(ball("{mass: -1}")), "obstacles[0].free.mass: "));
  CHECK(contains(solids_error(ball("{density: 500, lock: [x, roll]}")),
                 "obstacles[0].free.lock: \"roll\" is not one of x, y, z, rx, ry, rz; did you "
                 "mean rx?"));
  CHECK(contains(solids_error(ball("{dnsity: 500}")), "did you mean obstacles[0].free.density?"));
}

TEST_CASE("free bodies: one far lighter than the fluid is refused, by its density or its mass") {
  CHECK(solids_error(ball("{density: 10}")) == "no error");
  CHECK(
      contains(solids_error(ball("{density: 9.9}")),
               "obstacles[0].free.density: is 9.9 kg/m^3, 0.0099 of fluid.rest_density: the fluid "
               "would throw about so light a body, whose coupling to it is tested down to 0.05; "
               "give at least 10"));
  CHECK(solids_error(ball("{density: 9.9}"), {"fluid.rest_density=900"}) == "no error");
  // The ball has 0.03351 m^3.
  CHECK(solids_error(ball("{mass: 0.336}")) == "no error");
  CHECK(contains(solids_error(ball("{mass: 0.3}")),
                 "obstacles[0].free.mass: makes a density of 8.952 kg/m^3, 0.009 of "
                 "fluid.rest_density: the fluid would throw about so light a body, whose coupling "
                 "to it is tested down to 0.05; give at least 0.3351 kg"));
  // The disc has 0.12566 m^2.
  CHECK(solids_error(ball("{mass: 1.26}"), kFlatBox) == "no error");
  CHECK(contains(solids_error(ball("{mass: 1.25}"), kFlatBox), "give at least 1.257 kg/m"));
}

TEST_CASE("free bodies: what else would move the obstacle, or stands against it, is refused") {
  const std::string beside =
      "obstacles[0].free: is given beside motion, which says where the "
      "obstacle is; remove one of them";
  CHECK(contains(solids_error("{name: a, shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.2, "
                              "free: {density: 500}, motion: {kind: velocity}}"),
                 beside));
  CHECK(contains(solids_error(ball(kHeavy), {},
                              "tank_motion: {kind: sine, direction: [1, 0, 0], amplitude: 0.1, "
                              "period: 1}\n"),
                 "obstacles[0].free: does not go with tank_motion: free bodies do not feel the "
                 "forces in a tank that moves; remove one of them"));
  const std::string periodic = solids_error(ball(kHeavy), {"domain.periodic=[x]"});
  CHECK(contains(periodic,
                 "obstacles[0].free: does not go with domain.periodic: obstacles have "
                 "no images beyond periodic faces; remove one of them"));
  CHECK(contains(solids_error("{name: a, shape: plane, point: [0, 0, 0.1], normal: [0, 0, 1], "
                              "free: {density: 500}}"),
                 "obstacles[0].free: a plane has no end, and no mass; give a box, sphere, "
                 "cylinder, capsule or mesh to what the fluid moves"));
  CHECK(contains(solids_error("{name: a, shape: heights, path: b.csv, free: {density: 500}}"),
                 "obstacles[0].free: a heights has no end, and no mass"));
  CHECK(solids_error("{name: a, shape: mesh, path: b.stl, free: {density: 500}}") == "no error");
  CHECK(solids_error("{name: a, shape: mesh, path: b.stl, free: {mass: 500}}") == "no error");
  CHECK(contains(parse_error(kMinimal + "obstacles: [" + ball(kHeavy) +
                             "]\ngauges: [{name: P, kind: pressure, on: a, at: [0.5, 0.5, 0.7], "
                             "radius: 0.2}]\n"),
                 "gauges[0].on: a moves, and a pressure gauge stays where it is"));
}

TEST_CASE("free bodies in two dimensions stay in the plane") {
  CHECK(solids_error(ball("{density: 500, velocity: [1, 0, 2], angular: [0, 3, 0]}"), kFlatBox) ==
        "no error");
  CHECK(contains(solids_error(ball("{density: 500, velocity: [0, 1, 0]}"), kFlatBox),
                 "obstacles[0].free.velocity: its y component is 1, with dimensions: 2 nothing "
                 "moves along y; give 0"));
  CHECK(contains(solids_error(ball("{density: 500, angular: [1, 0, 0]}"), kFlatBox),
                 "obstacles[0].free.angular: with dimensions: 2 nothing turns but about y; give "
                 "[0, 1, 0] times a number"));
}

TEST_CASE("free bodies: one that reaches through a wall at the start is refused by the wall") {
  const auto at = [](const std::string& center, const std::vector<std::string>& set = {}) {
    return solids_error(ball(kHeavy, center), set);
  };
  for (const char* inside : {"[0.2, 0.8, 0.5]", "[0.5, 0.5, 0.2]", "[0.5, 0.5, 0.196]"})
    CHECK(at(inside) == "no error");
  CHECK(contains(at("[0.5, 0.5, 0.19]"),
                 "obstacles[0].free: the body reaches 0.01 m through the wall z_min at the start, "
                 "where nothing holds it; move it in, or make it smaller"));
  CHECK(contains(at("[0.9, 0.5, 0.5]"), "0.1 m through the wall x_max"));
  CHECK(at("[0.9, 0.5, 0.5]", {"domain.open=[x_max]"}) == "no error");
  CHECK(contains(at("[0.5, -3, 0.5]"), "3.2 m through the wall y_min"));
  CHECK(at("[0.5, 0.05, 0.5]", kFlatBox) == "no error");  // y has no walls there
  const std::string plate =
      "{name: a, shape: box, center: [0.5, 0.5, 0.5], size: [0.9, 0.2, 0.2], "
      "turn_axis: [0, 1, 0], free: {density: 500}, turn_angle: ";
  CHECK(solids_error(plate + "0}") == "no error");
  CHECK(solids_error(plate + "45}") == "no error");
  CHECK(contains(solids_error("{name: a, shape: box, center: [0.5, 0.5, 0.2], size: [0.9, 0.2, "
                              "0.2], turn_axis: [0, 1, 0], free: {density: 500}, turn_angle: 45}"),
                 "through the wall z_min"));
}

TEST_CASE("free bodies: one that overlaps an obstacle at the start is refused with its name") {
  const auto beside = [](const std::string& other, const std::vector<std::string>& set = {}) {
    return solids_error(ball(kHeavy) + ", " + other, set);
  };
  const auto sphere = [](const char* x) {
    return "{name: b, shape: sphere, radius: 0.1, center: [" + std::string(x) + ", 0.5, 0.5]}";
  };
  CHECK(beside(sphere("0.8")) == "no error");
  CHECK(beside(sphere("0.796")) == "no error");  // touches it, but for rounding
  CHECK(
      contains(beside(sphere("0.78")),
               "obstacles[0].free: the body overlaps obstacles[1] (b) by 0.02 m at the start, and "
               "would be thrown out of it; part them, or let them touch"));
  CHECK(contains(beside(sphere("0.5")), "overlaps obstacles[1] (b)"));  // one inside the other
  const std::string slope = "{name: b, shape: plane, normal: [1, 0, 1], point: [";
  CHECK(beside(slope + "0.35, 0, 0.35]}") == "no error");  // 0.2121 m from the middle
  CHECK(contains(beside(slope + "0.4, 0, 0.4]}"), "overlaps obstacles[1] (b)"));
  // Of two free bodies the later one.
  const std::string two = solids_error(ball(kHeavy) +
                                       ", {name: b, shape: sphere, radius: 0.1, "
                                       "center: [0.6, 0.5, 0.5], free: {density: 500}}");
  CHECK(contains(two, "obstacles[1].free: the body overlaps obstacles[0] (a)"));
  CHECK_FALSE(contains(two, "obstacles[0].free: "));
  // In two dimensions cuts count, not bodies.
  const std::string far = "{name: b, shape: sphere, radius: 0.2, center: [0.6, 0.9, 0.5]}";
  CHECK(contains(beside(far, kFlatBox), "overlaps obstacles[1] (b)"));
  CHECK(beside(far) == "no error");
  // The casing of an emitter.
  CHECK(contains(solids_error(ball(kHeavy), {},
                              "emitters: [{name: jet, shape: disc, center: [0.6, 0.5, 0.5], "
                              "normal: [0, 0, -1], radius: 0.1, speed: 1}]\n"),
                 "overlaps obstacle a"));
}

TEST_CASE("free bodies: time.step auto goes by their speed at the start") {
  const auto step = [](const std::string& free) {
    Scene s = with_solids(ball(free), {"time.step=auto", "gravity=[0, 0, 0]"});
    read_linked_files(s, ".", true);
    return s.time.step;
  };
  CHECK(step("{density: 500, velocity: [0, 2, 0]}") == Approx(0.02));  // 0.2 h
  // The surface at 0.2 m goes at 0.4 m/s.
  CHECK(step("{density: 500, angular: [0, 0, 114.59155902616465]}") == Approx(0.1));
  CHECK(contains(error_of([&] { step(kHeavy); }), "nothing moves; give a number"));
}

}  // namespace pbf::scene_test
