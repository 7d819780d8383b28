// What a scene may say of gauges, and every error about them with its remedy.
#include <cmath>

#include "lib/scene/surface.h"
#include "lib/scene/vector3.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

std::string gauge_error(const std::string& gauges, const std::vector<std::string>& set = {}) {
  return parse_error(kMinimal +
                         "obstacles:\n"
                         "  - {name: box, shape: box, min: [0.2, 0.2, 0], max: [0.5, 0.5, 0.3]}\n"
                         "  - {name: ball, shape: sphere, center: [0.8, 0.8, 0.5], radius: 0.15}\n"
                         "gauges: [" +
                         gauges + "]\n",
                     set);
}
/// The keys of the first gauge.
gauge_keys::Level level_of(const Scene& s) {
  return std::get<gauge_keys::Level>(s.gauges.at(0).kind);
}
const std::vector<std::string> kFlat = {"dimensions=2", "domain.max=[1, 0.1, 1]",
                                        "obstacles=[{name: box, shape: box, min: [0.2, 0, 0], "
                                        "max: [0.5, 0.1, 0.3]}]"};
std::string pressure(const std::string& on, const std::string& at, const char* radius = "0.2") {
  return "{name: p, kind: pressure, on: " + on + ", at: " + at + ", radius: " + radius + "}";
}

}  // namespace

TEST_CASE("gauges: every kind with its keys is read") {
  const Scene s = parse(kMinimal +
                        "gauges:\n"
                        "  - {name: H, kind: level, at: [0.5, 0.25]}\n"
                        "  - {name: U, kind: velocity, at: [0.5, 0.5, 0.1]}\n"
                        "  - {name: Q, kind: flow, center: [0.5, 0.5, 0.1], normal: [1, 0, 0],\n"
                        "     size: [1, 0.2]}\n"
                        "  - {name: P, kind: pressure, on: x_max, at: [1, 0.5, 0.1], radius: 0.2}\n"
                        "  - {name: R, kind: line, from: [0, 0.5, 0], to: [1, 0.5, 1],\n"
                        "     connected: true}\n"
                        "  - {name: V, kind: velocity, at: [0.5, 0.5, 0.1], within: 0.16}\n"
                        "output: {gauges_every: 0.05}\n");
  REQUIRE(s.gauges.size() == 6);
  CHECK(level_of(s).at == std::vector<double>{0.5, 0.25});
  CHECK(std::get<gauge_keys::Velocity>(s.gauges[1].kind).at == std::vector<double>{0.5, 0.5, 0.1});
  CHECK(std::get<gauge_keys::Flow>(s.gauges[2].kind).size == std::vector<double>{1, 0.2});
  CHECK(std::get<gauge_keys::Pressure>(s.gauges[3].kind).on == "x_max");
  CHECK(std::get<gauge_keys::Line>(s.gauges[4].kind) ==
        gauge_keys::Line{{0, 0.5, 0}, {1, 0.5, 1}, true});
  CHECK(std::get<gauge_keys::Velocity>(s.gauges[5].kind).within == 0.16);
  CHECK_FALSE(std::get<gauge_keys::Velocity>(s.gauges[1].kind).within);
  CHECK_FALSE(level_of(s).connected);
  CHECK(s.output->gauges_every == 0.05);
  CHECK(parse(kMinimal).gauges.empty());
  CHECK_FALSE(parse(kMinimal + "output: {}\n").output->gauges_every);
  CHECK(parse_scene(resolved_yaml(s), "again.yaml", {}) == s);
}

TEST_CASE("gauges: a place in the list is changed from the command line") {
  const std::string text = kMinimal + "gauges: [{name: H, kind: level, at: [0.5, 0.25]}]\n";
  CHECK(level_of(parse(text, {"gauges[0].at=[0.1, 0.2]"})).at == std::vector<double>{0.1, 0.2});
  CHECK(contains(parse_error(text, {"gauges[0].att=[0.1, 0.2]"}), "did you mean gauges[0].at?"));
}

TEST_CASE("gauges: names that cannot name data of the run file are refused") {
  const auto named = [](const std::string& name) {
    return gauge_error("{name: " + name + ", kind: level, at: [0.1, 0.1]}");
  };
  CHECK(named("H 1") == "no error");
  CHECK(named("box") == "no error");
  for (const char* name : {"a/b", ".", ".."})
    CHECK(contains(named(name), "gauges[0].name: \"" + std::string(name) +
                                    "\" cannot name data of the run file"));
  for (const char* name : {"time", "update", "total", "peak"})
    CHECK(contains(named(name), "gauges[0].name: is a name that /pbf/gauges has already"));
  CHECK(contains(gauge_error("{name: a, kind: level, at: [0.1, 0.1]}, "
                             "{name: a, kind: velocity, at: [0.1, 0.1, 0.1]}"),
                 "gauges[1].name: is also the name of gauges[0]; choose another"));
}

TEST_CASE("gauges: places have as many numbers as their kind needs, and lie in the domain") {
  const auto level = [](const std::string& at, const std::vector<std::string>& set = {}) {
    return gauge_error("{name: a, kind: level, at: " + at + "}", set);
  };
  CHECK(contains(level("[0.1, 0.1, 0.1]"),
                 "gauges[0].at: has 3 numbers, and a level is read along z, the axis of gravity; "
                 "give [x, y]"));
  CHECK(contains(level("[0.1]", {"gravity=[0, 9, 1]"}),
                 "read along y, the axis of gravity; give "
                 "[x, z]"));
  CHECK(level("[0.1]", kFlat) == "no error");
  CHECK(contains(level("[0.1, 0.1]", kFlat), "give [x]"));
  CHECK(contains(level("[0.1, 1.5]"),
                 "gauges[0].at: y is 1.5, outside the domain (y from 0 to 1 m); move the gauge"));
  CHECK(contains(level("[]"), "gauges[0].at: expected a list of 1 to 3 numbers"));
  CHECK(contains(level("0.5"), "gauges[0].at: expected a list of 1 to 3 numbers, got \"0.5\""));
  CHECK(contains(level("[0.5, b]"), "element 1: expected a number, got \"b\""));
  CHECK(contains(gauge_error("{name: a, kind: velocity, at: [0.1, 0.1]}"),
                 "gauges[0].at: has 2 numbers, expected a place, [x, y, z]"));
  CHECK(contains(gauge_error("{name: a, kind: velocity, at: [0.1, 0.1, -0.1]}"),
                 "z is -0.1, outside the domain"));
}

TEST_CASE("gauges: a line has two ends in the domain, and a velocity enough room for particles") {
  const auto line = [](const std::string& rest, const std::vector<std::string>& set = {}) {
    return gauge_error("{name: a, kind: line, " + rest + "}", set);
  };
  CHECK(line("from: [0, 0.5, 0], to: [1, 0.5, 1], connected: true") == "no error");
  CHECK(line("from: [0, 0], to: [1, 1]", kFlat) == "no error");
  CHECK(contains(line("from: [0, 0.5, 0]"), "gauges[0].to: missing"));
  CHECK(contains(line("from: [0, 0.5, 0], to: [1, 0.5, 1.2]"),
                 "gauges[0].to: z is 1.2, outside the domain (z from 0 to 1 m); move the gauge"));
  CHECK(contains(line("from: [0.2, 0.5, 0.3], to: [0.2, 0.5, 0.3]"),
                 "gauges[0].to: is 0 m from `from`, less than fluid.spacing (0.1 m); move one of "
                 "them away"));
  CHECK(line("from: [0.1, 0.5, 0.1], to: [0.2, 0.5, 0.1]") == "no error");
  CHECK(contains(line("from: [0.2, 0, 0.3], to: [0.2, 0.1, 0.3]", kFlat), "is 0 m from `from`"));
  CHECK(contains(line("at: [0.2, 0.5]"), "gauges[0].at"));
  CHECK(contains(gauge_error("{name: a, kind: velocity, at: [0.1, 0.1, 0.1], within: 0.09}"),
                 "gauges[0].within: is 0.09, below fluid.spacing (0.1 m), where often no particle "
                 "is; enlarge it"));
  CHECK(contains(gauge_error("{name: a, kind: level, at: [0.1, 0.1], connected: 2}"),
                 "gauges[0].connected"));
}

TEST_CASE("gauges: rectangles without extent or direction are refused") {
  const auto flow = [](const std::string& rest, const std::vector<std::string>& set = {}) {
    return gauge_error("{name: a, kind: flow, center: [0.5, 0.5, 0.5], " + rest + "}", set);
  };
  CHECK(flow("normal: [1, 1, 0], size: [1, 0.2]") == "no error");
  CHECK(contains(flow("normal: [0, 0, 0], size: [1, 1]"),
                 "gauges[0].normal: has no direction; give the way that counts as positive"));
  CHECK(contains(flow("normal: [1, 0, 0], size: [1]"),
                 "gauges[0].size: has 1 number, expected two, the edges of a rectangle"));
  CHECK(
      contains(flow("normal: [1, 0, 0], size: [1, 0]"), "gauges[0].size: element 1: \"0\" is out"));
  CHECK(flow("normal: [1, 0, 0], size: [1]", kFlat) == "no error");
  CHECK(contains(flow("normal: [1, 0, 0], size: [1, 1]", kFlat),
                 "expected one, the length of a line in the x-z plane (dimensions: 2)"));
  CHECK(
      contains(flow("normal: [1, 1, 0], size: [1]", kFlat), "gauges[0].normal: has a y component"));
}

TEST_CASE("gauges: a pressure gauge lies on the surface that it names, where fluid comes") {
  CHECK(gauge_error(pressure("box", "[0.2, 0.35, 0.15]")) == "no error");
  CHECK(gauge_error(pressure("z_min", "[0.8, 0.35, 0]")) == "no error");
  const std::string off = gauge_error(pressure("box", "[0.53, 0.35, 0.15]"));
  CHECK(contains(off,
                 "gauges[0].at: is 0.03 m from the surface of box; a pressure gauge lies on it "
                 "(nearest point (0.5, 0.35, 0.15))"));
  CHECK(contains(gauge_error(pressure("bax", "[0.2, 0.35, 0.15]")),
                 "gauges[0].on: no obstacle is named bax, and no wall of the domain; did you mean "
                 "box?"));
  for (const auto& [written, wall] :
       std::vector<std::pair<std::string, std::string>>{{"floor", "z_min"},
                                                        {"bottom", "z_min"},
                                                        {"Ground", "z_min"},
                                                        {"left wall", "x_min"},
                                                        {"back_wall", "y_max"},
                                                        {"lid", "z_max"},
                                                        {"zmin", "z_min"},
                                                        {"east", "x_max"}})
    CHECK(contains(gauge_error(pressure(written, "[0.2, 0.35, 0.15]")),
                   "no wall of the domain; did you mean " + wall + "? There are x_min, x_max"));
  CHECK(contains(gauge_error(pressure("somewhere", "[0.2, 0.35, 0.15]")),
                 "no wall of the domain; there are x_min, x_max"));
  CHECK(contains(gauge_error(pressure("box", "[0.35, 0.35, 0]")),
                 "gauges[0].at: no fluid comes to this place of box"));
  CHECK(contains(gauge_error(pressure("z_min", "[0.3, 0.3, 0]")),
                 "gauges[0].at: no fluid comes to this place of z_min"));
  CHECK(contains(gauge_error(pressure("box", "[0.2, 0.35, 0.15]", "0.15")),
                 "gauges[0].radius: is 0.15, below 2 fluid.spacing (0.2 m): so few particles have "
                 "no mean; enlarge it or lower fluid.spacing to 0.075"));
  CHECK(contains(gauge_error(pressure("ball", "[0.8, 0.8, 0.65]")),
                 "gauges[0].radius: is 0.2, more than the radius of ball less fluid.spacing"));
  CHECK(contains(gauge_error(pressure("x_max", "[1, 0.5, 0.5]"), {"domain.open=[x_max]"}),
                 "gauges[0].on: x_max is open, without a wall (domain.open); give another"));
  CHECK(contains(gauge_error(pressure("y_min", "[0.5, 0, 0.5]"), kFlat),
                 "gauges[0].on: y_min is no wall with dimensions: 2; give another"));
  CHECK(gauge_error(pressure("box", "[0.2, 0, 0.15]"), kFlat) == "no error");
}

TEST_CASE("gauges: keys of other kinds, missing and unknown ones are refused by name") {
  CHECK(contains(gauge_error("{name: a, kind: level}"), "gauges[0].at"));
  CHECK(contains(gauge_error("{name: a, kind: level, at: [0, 0], radius: 1}"), "gauges[0].radius"));
  CHECK(contains(gauge_error("{name: a, kind: probe, at: [0, 0]}"), "gauges[0].kind"));
  CHECK(contains(gauge_error("{kind: level, at: [0, 0]}"), "gauges[0].name"));
  CHECK(contains(parse_error(kMinimal + "gauge: []\n"), "did you mean gauges?"));
  CHECK(contains(parse_error(kMinimal + "output: {gauges_every: 0.001}\n"),
                 "output.gauges_every: is 0.001, below time.step (0.01 s)"));
}

TEST_CASE("gauges: levels do not know pressure gauges on walls, on obstacles they do") {
  const std::string text =
      kMinimal + "gauges: [" + pressure("x_min", "[0, 0.5, 0.3]") + "]\nsolver: {levels: on}\n";
  CHECK(contains(parse_error(text),
                 "solver.levels: pressure gauges on walls do not see what the levels push; give "
                 "off or auto, or put them on obstacles"));
  CHECK(parse_error(text, {"solver.levels=auto"}) == "no error");
  CHECK(parse_error(text, {"obstacles=[{name: a, shape: box, min: [0, 0.3, 0], max: [0.4, 0.7, "
                           "1]}]",
                           "gauges.0.on=a", "gauges.0.at=[0.4, 0.5, 0.5]"}) == "no error");
}

TEST_CASE("surfaces: the nearest place is on the surface, along the normal, as far as it is said") {
  const Scene s = parse(
      kMinimal +
      "obstacles:\n"
      "  - {name: p, shape: plane, point: [0, 0, 0.1], normal: [0, 3, 4]}\n"
      "  - {name: b, shape: box, min: [0.2, 0.2, 0.1], max: [0.5, 0.6, 0.3], turn_axis: [1, 2, "
      "3],\n"
      "     turn_angle: 40}\n"
      "  - {name: s, shape: sphere, center: [0.7, 0.2, 0.3], radius: 0.2}\n"
      "  - {name: c, shape: cylinder, from: [0.1, 0.2, 0.1], to: [0.5, 0.8, 0.9], radius: 0.25}\n"
      "  - {name: k, shape: capsule, from: [0.1, 0.2, 0.1], to: [0.5, 0.8, 0.9], radius: 0.25}\n");
  std::mt19937 gen(5);
  const auto random = [&] { return double(gen()) / 4294967295.0; };
  for (const Obstacle& o : s.obstacles)
    for (int k = 0; k < 300; ++k) {
      const Double3 x{random(), random(), random()};
      const SurfacePlace p = nearest_place(o, s, x);
      CAPTURE(o.name, x[0], x[1], x[2], p.distance);
      CHECK(length(p.point - x) == Approx(std::fabs(p.distance)).margin(1e-12));
      CHECK(length(p.normal) == Approx(1));
      const SurfacePlace on = nearest_place(o, s, p.point);
      CHECK(std::fabs(on.distance) < 1e-12);
      const SurfacePlace out = nearest_place(o, s, p.point + 1e-6 * p.normal);
      CHECK(out.distance > 0);
      for (int t = 0; t < 20; ++t) {  // nothing of the surface is nearer
        const Double3 other = nearest_place(o, s, {random(), random(), random()}).point;
        CHECK(length(other - x) >= std::fabs(p.distance) - 1e-12);
      }
    }
}

}  // namespace pbf::scene_test
