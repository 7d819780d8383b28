// The key domain.periodic: what it refuses, with the remedy.
#include "lib/scene/periodic.h"

#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

const std::string kTwo = "domain.periodic=[x, y]";
const std::string kFlatPeriodic =
    "dimensions: 2\ndomain: {min: [0, 0], max: [1, 1], periodic: [x]}\nfluid: {spacing: 0.05}\n"
    "bodies: [{shape: block, min: [0, 0], max: [1, 0.5]}]\ntime: {step: 0.01, end: 1}\n";

void is_refused(const std::string& text, const std::vector<std::string>& set,
                const std::string& because) {
  CAPTURE(set);
  const std::string error = parse_error(text, set);
  CAPTURE(error);
  CHECK(contains(error, "2 "));
  CHECK(contains(error, because));
}

}  // namespace

TEST_CASE("periodic axes are read, and their faces are neither walls nor open") {
  const Scene s = parse(kMinimal, {kTwo});
  CHECK(periodic_axes(s) == std::vector<int>{0, 1});
  CHECK(periods(s) == Double3{1, 1, 0});
  CHECK(s.domain.has_wall(2, false));
  CHECK_FALSE(s.domain.has_wall(0, true));
  CHECK_FALSE(s.domain.is_open(0, true));
  CHECK_FALSE(s.domain.is_closed());
  CHECK(periods(parse(kFlatPeriodic)) == Double3{1, 0, 0});
}

TEST_CASE("periodic axes that are unknown, named twice, flat, open or too short are refused") {
  is_refused(kMinimal, {"domain.periodic=[w]"}, "\"w\" is not one of x, y, z");
  is_refused(kMinimal, {"domain.periodic=[x, x]"}, "\"x\" is listed twice");
  is_refused(kFlatPeriodic, {"domain.periodic=[x, y]"},
             "with dimensions: 2 nothing moves along y; remove it");
  is_refused(kMinimal, {kTwo, "domain.open=[y_max]"},
             "y_max is joined to the opposite face (domain.periodic); remove one");
  is_refused(kMinimal, {kTwo, "domain.max=[0.59, 1, 1]", "bodies.0.max=[0.59, 1, 0.5]"},
             "x: the domain is 0.59 m long along it");
  is_refused(kMinimal, {kTwo, "domain.max=[0.59, 1, 1]", "bodies.0.max=[0.59, 1, 0.5]"},
             "give at least 3 smoothing lengths, 0.6");
  CHECK(parse_error(kMinimal, {kTwo, "domain.max=[0.6, 1, 1]", "bodies.0.max=[0.6, 1, 0.5]"}) ==
        "no error");
}

TEST_CASE("what has no period is refused in a periodic scene by its key") {
  is_refused(kMinimal, {kTwo, "gravity=[1, 0, -9.81]"}, "gravity: its component along x is 1");
  is_refused(kMinimal, {"domain.periodic=[z]"}, "gravity: its component along z is -9.81");
  is_refused(kMinimal, {kTwo, "settle.gravity=[0, 2, -9.81]"},
             "settle.gravity: its component along y is 2");
  is_refused(kMinimal, {kTwo, "solver.levels=on"}, "solver.levels: the grids of levels end at");
  CHECK(parse_error(kMinimal, {kTwo, "solver.levels=auto"}) == "no error");
  const auto box = [](const std::string& low, const std::string& high, const std::string& more) {
    return "obstacles=[{name: post, shape: box, min: [" + low + ", 0.4, 0], max: [" + high +
           ", 0.6, 0.5]" + more + "}]";
  };
  is_refused(kMinimal, {kTwo, box("0.29", "0.6", "")},
             "reaches x = 0.29, and obstacles have no images beyond periodic faces: leave 1.5 "
             "smoothing lengths, x from 0.3 to 0.7");
  is_refused(kMinimal, {kTwo, box("0.4", "1", "")}, "reaches x = 1");
  CHECK(parse_error(kMinimal, {kTwo, box("0.3", "0.7", "")}) == "no error");
  CHECK(parse_error(kMinimal, {"domain.periodic=[y]", box("0", "1", "")}) == "no error");
  is_refused(kMinimal, {kTwo, box("0.4", "0.6", ", motion: {kind: velocity, velocity: [0, 0, 1]}")},
             "post moves, and obstacles have no images");
  is_refused(kMinimal,
             {kTwo,
              "obstacles=[{name: slope, shape: plane, point: [0.5, 0.5, 0.1], normal: [1, 0, "
              "1]}]"},
             "leave 1.5");
  // A plane along the axes is its own image, as long as it does not turn.
  const auto lid = [](const std::string& motion) {
    return "obstacles=[{name: lid, shape: plane, point: [0.5, 0.5, 0.9], normal: [0, 0, -1]" +
           motion + "}]";
  };
  CHECK(parse_error(kMinimal, {kTwo, lid("")}) == "no error");
  CHECK(parse_error(kMinimal, {kTwo, lid(", motion: {kind: velocity, velocity: [1, 0, 0]}")}) ==
        "no error");
  CHECK(parse_error(kMinimal, {kTwo, lid(", motion: {kind: sine, direction: [0, 0, 1], amplitude: "
                                         "0.1, period: 1}")}) == "no error");
  is_refused(kMinimal, {kTwo, lid(", motion: {kind: velocity, angular: [0, 10, 0]}")},
             "make it a plane along x that does not turn");
  is_refused(kMinimal,
             {kTwo, lid(", motion: {kind: sine, axis: [0, 1, 0], amplitude: 5, period: 1}")},
             "lid moves");
  is_refused(kMinimal, {kTwo, "tank_motion={kind: sine, axis: [0, 1, 0], amplitude: 5, period: 1}"},
             "so they have no period; give a direction");
  CHECK(parse_error(kMinimal, {kTwo,
                               "tank_motion={kind: sine, direction: [1, 0, 0], amplitude: "
                               "0.1, period: 1}"}) == "no error");
}

TEST_CASE("gauges in a periodic scene stay clear of its periodic faces, and count no flow") {
  is_refused(kMinimal,
             {kTwo, "gauges=[{name: f, kind: flow, center: [0.5, 0.5, 0.5], size: [1, 1]}]"},
             "flow gauges take a return through a periodic face for flow back");
  is_refused(kMinimal, {kTwo, "gauges=[{name: v, kind: velocity, at: [0.1, 0.5, 0.5]}]"},
             "x is 0.1, and a gauge does not see through a periodic face: give x from 0.2 to 0.8");
  is_refused(kMinimal, {kTwo, "gauges=[{name: l, kind: level, at: [0.5, 0.9]}]"}, "y is 0.9");
  CHECK(parse_error(kMinimal, {kTwo,
                               "gauges=[{name: l, kind: level, at: [0.5, 0.5]}, {name: v, "
                               "kind: velocity, at: [0.2, 0.8, 0.05]}]"}) == "no error");
  is_refused(
      kMinimal,
      {kTwo, "gauges=[{name: p, kind: pressure, at: [0.1, 0.5, 0], on: z_min, radius: 0.2}]"},
      "x is 0.1");
}

TEST_CASE("the shortest displacement, as computed by hand") {
  CHECK(shortest(0.9, 1) == Approx(-0.1));
  CHECK(shortest(-2.2, 1) == Approx(-0.2));
  CHECK(shortest(0.9, 0) == 0.9);
}

}  // namespace pbf::scene_test
