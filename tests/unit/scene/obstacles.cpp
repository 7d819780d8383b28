// What a scene may say of obstacles, and every error about them with its remedy.
#include <cmath>
#include <iomanip>
#include <sstream>

#include "lib/scene/key_rows.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

const std::string kBox = "{name: a, shape: box, min: [0.2, 0.2, 0], max: [0.5, 0.5, 0.3]}";

std::string obstacle_error(const std::string& obstacles, const std::vector<std::string>& set = {}) {
  return parse_error(kMinimal + "obstacles: [" + obstacles + "]\n", set);
}
std::string flat_error(const std::string& obstacles) {
  return obstacle_error(obstacles, {"dimensions=2", "domain.max=[1, 0.1, 1]"});
}
/// A cylinder or a capsule; h is 0.2 m.
std::string tube(const std::string& shape, const std::string& from, const std::string& to,
                 const std::string& radius = "0.2") {
  return "{name: t, shape: " + shape + ", from: " + from + ", to: " + to + ", radius: " + radius +
         "}";
}

}  // namespace

TEST_CASE("obstacles: shapes share a key only where they say the same of it") {
  const auto row = [](unsigned kind) {
    Key k{"obstacles[].end", "One end.", [](const Object&) { return Field{}; }};
    k.unit = "m", k.range = {0, 1}, k.required = true, k.kinds = 1u << kind, k.flat = FlatY::low;
    return k;
  };
  std::vector<Key> rows;
  add_kind_row(rows, row(1));
  add_kind_row(rows, row(2));
  Key middle = row(3);
  middle.flat = FlatY::middle;
  add_kind_row(rows, middle);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].kinds == 14);
  CHECK(rows[0].in_plane == 8);
  CHECK(rows[0].flat == FlatY::low);
  void (*const changes[])(Key&) = {[](Key& k) { k.unit = "s"; },
                                   [](Key& k) { k.help = "The end."; },
                                   [](Key& k) { k.required = false; },
                                   [](Key& k) { k.by_center = true; },
                                   [](Key& k) { k.range.above_min = true; },
                                   [](Key& k) { k.flat = FlatY::high; }};
  for (const auto change : changes) {
    Key other = row(4);
    change(other);
    CHECK_THROWS_WITH(add_kind_row(rows, other), Catch::Contains("obstacles[].end: two kinds"));
  }
  std::vector<Key> turned{middle};  // another order of the list of shapes
  CHECK_THROWS_WITH(add_kind_row(turned, row(1)), Catch::Contains("differ"));
}

TEST_CASE("obstacles: every shape with its keys is read, what is not given has its default") {
  const Scene s =
      parse(kMinimal +
            "obstacles:\n"
            "  - {name: p, shape: plane, point: [0, 0, 0.1], normal: [0, 3, 4]}\n"
            "  - " +
            kBox +
            "\n"
            "  - {name: c, shape: sphere, center: [1, 2, 3], radius: 0.01, loads: true}\n"
            "  - " +
            tube("cylinder", "[1, 1, 1]", "[1, 1, 2]", "0.5") + "\n");
  REQUIRE(s.obstacles.size() == 4);
  CHECK(s.obstacles[0].as<obstacle_keys::Plane>().normal == Double3{0, 3, 4});
  CHECK(s.obstacles[1].as<obstacle_keys::Box>().max == Double3{0.5, 0.5, 0.3});
  CHECK(s.obstacles[1].as<obstacle_keys::Box>().turn_angle == 0);
  CHECK_FALSE(s.obstacles[1].loads);
  CHECK(s.obstacles[2].loads);
  CHECK(s.obstacles[2].as<obstacle_keys::Sphere>().radius ==
        0.01);  // balls may be as small as they like
  CHECK(s.obstacles[3].as<obstacle_keys::Cylinder>().to == Double3{1, 1, 2});
  CHECK(parse(kMinimal).obstacles.empty());
}

TEST_CASE("obstacles: a plate so thin that rounding puts fluid on its other side is refused") {
  // The box is 5 h long: positions are 2^-21 h apart in float, 2^-50 h in double; h is 0.2 m.
  const auto plate = [](double thick, const std::string& precision) {
    std::ostringstream text;
    text << std::setprecision(17) << "{name: a, shape: box, min: [-1, 0, 0], max: [2, 1, " << thick
         << "]}";
    return obstacle_error(text.str(), {"precision=" + precision});
  };
  const double least = 8 * 0.2 * std::ldexp(1, -21);
  CHECK(plate(1.001 * least, "float") == "no error");
  CHECK(contains(plate(0.999 * least, "float"),
                 "obstacles[0].max: makes a plate 7.62e-07 m thick, and positions in float are "
                 "9.54e-08 m apart at the far end of the domain: fluid would pass through it; give "
                 "at least 8e-07 m, or precision: double"));
  CHECK(plate(0.999 * least, "double") == "no error");
  CHECK(contains(plate(1e-16, "double"), "in double are 1.78e-16 m apart"));
  CHECK(contains(obstacle_error(tube("cylinder", "[0.5, 0.5, 0]", "[0.5, 0.5, 1.0e-9]")),
                 "obstacles[0].to: makes a plate 1e-09 m thick"));
  CHECK(flat_error("{name: a, shape: box, min: [0.2, 0, 0], max: [0.5, 1.0e-9, 0.3]}") ==
        "no error");  // there y does not count
}

TEST_CASE("obstacles: names that cannot name columns of the log are refused") {
  const auto named = [](const std::string& name) {
    return obstacle_error("{name: " + name + ", shape: sphere, center: [0, 0, 0], radius: 1}");
  };
  CHECK(contains(named("\"\""), "obstacles[0].name: is empty, expected text"));
  for (const char* name : {"a/b", "/", ".", ".."})
    CHECK(contains(named(name), "cannot name columns of the log; give a word without \"/\""));
  for (const char* name : {"x_min", "y_max", "z_min"})
    CHECK(contains(named(name),
                   "obstacles[0].name: is the name of a wall of the domain; choose another"));
  for (const char* name : {"x_mine", "w_min", "x"}) CHECK(named(name) == "no error");
  const std::string twice = obstacle_error(kBox +
                                           ", {name: b, shape: plane, point: [0, 0, 0], "
                                           "normal: [0, 0, 1]}, " +
                                           kBox);
  CHECK(contains(twice, "obstacles[2].name: is also the name of obstacles[0]; choose another"));
  CHECK(twice.rfind("2 ", 0) == 0);
}

TEST_CASE("obstacles: shapes without extent, direction or curvature are refused") {
  CHECK(obstacle_error(kBox) == "no error");
  CHECK(contains(obstacle_error("{name: a, shape: box, min: [0, 0.5, 0], max: [1, 0.4, 1]}"),
                 "obstacles[0].max: y is 0.4, not above obstacles[0].min (0.5)"));
  CHECK(contains(obstacle_error("{name: a, shape: box, min: [0, 0, 0], max: [1, 1, 1], "
                                "turn_axis: [0, 0, 0], turn_angle: 5}"),
                 "obstacles[0].turn_axis: has no direction; give one, [0, 1, 0] say"));
  CHECK(contains(obstacle_error("{name: a, shape: plane, point: [0, 0, 0], normal: [0, 0, 0]}"),
                 "obstacles[0].normal: has no direction; give one away from the solid"));
  for (const char* shape : {"cylinder", "capsule"}) {
    CHECK(
        contains(obstacle_error(tube(shape, "[1, 2, 3]", "[1, 2, 3]")),
                 "obstacles[0].to: is where the axis begins (obstacles[0].from); give the other"));
    CHECK(contains(obstacle_error(tube(shape, "[0, 0, 0]", "[0, 0, 1]", "0.19")),
                   "obstacles[0].radius: is 0.19, below the smoothing length (0.2 m): the fluid "
                   "could not see how the surface is curved; enlarge it or lower fluid.spacing to "
                   "0.095"));
    CHECK(obstacle_error(tube(shape, "[0, 0, 0]", "[0, 0, 1]")) == "no error");
  }
}

TEST_CASE("obstacles: what two dimensions do not know is refused with the remedy") {
  CHECK(flat_error(kBox) == "no error");
  CHECK(contains(flat_error("{name: a, shape: plane, point: [0, 0, 0], normal: [1, 1, 0]}"),
                 "obstacles[0].normal: has a y component, with dimensions: 2"));
  const std::string box = "{name: a, shape: box, min: [0, 0, 0], max: [1, 1, 1], turn_axis: ";
  CHECK(contains(flat_error(box + "[0, 1, 1], turn_angle: 5}"),
                 "obstacles[0].turn_axis: with dimensions: 2 a box can only be turned about y"));
  CHECK(flat_error(box + "[0, -2, 0], turn_angle: 5}") == "no error");
  CHECK(flat_error(box + "[0, 0, 1]}") == "no error");  // not turned
  CHECK(contains(flat_error("{name: a, shape: sphere, center: [0, 0, 0], radius: 0.1}"),
                 "obstacles[0].radius: is 0.1, below the smoothing length (0.2 m)"));
  CHECK(contains(flat_error(tube("capsule", "[0, 0, 0]", "[0, 1, 0]")),
                 "obstacles[0].to: with dimensions: 2 a capsule lies in the x-z plane"));
  CHECK(flat_error(tube("capsule", "[0, 0.1, 0]", "[1, 0.1, 1]")) == "no error");
  for (const char* to : {"[1, 0, 0]", "[1, 1, 0]", "[0, 1, 1]"})
    CHECK(contains(flat_error(tube("cylinder", "[0, 0, 0]", to)),
                   "obstacles[0].to: with dimensions: 2 a cylinder stands on the x-z plane"));
  CHECK(flat_error(tube("cylinder", "[0, 0, 0]", "[0, 1, 0]")) == "no error");
}

TEST_CASE("obstacles: keys of other shapes, missing and unknown ones are refused by name") {
  CHECK(contains(obstacle_error("{name: a, shape: sphere, center: [0, 0, 0]}"),
                 "obstacles[0].radius"));
  CHECK(contains(obstacle_error("{shape: sphere, center: [0, 0, 0], radius: 1}"),
                 "obstacles[0].name"));
  CHECK(contains(
      obstacle_error("{name: a, shape: sphere, center: [0, 0, 0], radius: 1, min: [0, 0, 0]}"),
      "obstacles[0].min"));
  CHECK(
      contains(obstacle_error("{name: a, shape: cone, center: [0, 0, 0]}"), "obstacles[0].shape"));
  CHECK(contains(obstacle_error("{name: a, shape: sphere, center: [0, .nan, 0], radius: 1}"),
                 "obstacles[0].center"));
  CHECK(contains(obstacle_error("{name: a, shape: sphere, center: [0, 0, 0], radius: -1}"),
                 "obstacles[0].radius"));
}

}  // namespace pbf::scene_test
