// Rules for emitters and sinks: one message each, with the place and the remedy.
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

const std::string kScene =
    "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
    "fluid: {spacing: 0.05}\n"
    "bodies: [{shape: block, min: [0, 0, 0], max: [1, 1, 0.2]}]\n"
    "time: {step: 0.004, end: 0.5}\n";
std::string emitters(const std::string& entries) { return kScene + "emitters:\n" + entries; }
std::string jet(const std::string& more,
                const std::string& place = "center: [0.5, 0.5, 0.5], normal: [1, 0, 0]") {
  return "  - {name: jet, " + place + ", " + more + "}\n";
}

}  // namespace

TEST_CASE("emitters: what cannot be emitted is refused, with place, key and remedy") {
  const auto error = [](const std::string& entries, const std::vector<std::string>& set = {}) {
    return parse_error(emitters(entries), set);
  };
  CHECK(error(jet("shape: disc, radius: 0.1, speed: 1")) == "no error");
  CHECK(
      error(jet("shape: disc, radius: 0.1")) ==
      "2 scene.yaml:6:5: emitters[0].speed: missing: give a speed in m/s, or the path of a table");
  CHECK(error(jet("shape: disc, radius: 0.1, speed: 1, path: v.csv")) ==
        "2 scene.yaml:6:94: emitters[0].speed: is given beside path; remove one of them");
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: -1")),
                 "emitters[0].speed: \"-1\" is out of range, allowed: 0 .. 1000000"));
  CHECK(contains(error(jet("shape: disc, radius: 0.02, speed: 1")),
                 "emitters[0].radius: leaves no room for a column of particles 0.05 m wide: give "
                 "at least 0.025, or lower fluid.spacing"));
  CHECK(contains(error(jet("shape: rectangle, size: [0.2, 0.04], speed: 1")),
                 "emitters[0].size: leaves no room for a column"));
  CHECK(contains(error(jet("shape: rectangle, size: [0.2], speed: 1")),
                 "emitters[0].size: has 1 numbers, expected two edges, [level, other]"));
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 1, start: 2, end: 1")),
                 "emitters[0].end: is 1, not after start (2 s); raise it"));
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 100")),
                 "emitters[0].speed: makes 8 layers of particles in an update, at most 4 are "
                 "possible; give time.step 0.002 or less"));
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 1",
                           "center: [0.5, 0.5, 0.5], normal: [0, 0, 0]")),
                 "emitters[0].normal: has no direction; give one"));
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 1",
                           "center: [1.5, 0.5, 0.5], normal: [1, 0, 0]")),
                 "emitters[0].center: x is 1.5, outside the domain (x from 0 to 1 m)"));
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 1",
                           "center: [0.1, 0.5, 0.5], normal: [1, 0, 0]")),
                 "emitters[0]: reaches outside the domain with its held layers (0.129 m behind its "
                 "opening) at (-0.029, 0.4, 0.4); move it in, or open the domain's face x_min"));
  CHECK(
      error(jet("shape: disc, radius: 0.1, speed: 1", "center: [0.1, 0.5, 0.5], normal: [1, 0, 0]"),
            {"domain.open=[x_min]"}) == "no error");
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 1") +
                       "  - {name: jet, shape: disc, center: [0.45, 0.5, 0.5], normal: [1, 0, 0], "
                       "radius: 0.1, speed: 1}\n"),
                 "emitters[1].name: is also the name of emitters[0]"));
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 1") +
                       "  - {name: b, shape: disc, center: [0.45, 0.5, 0.5], normal: [1, 0, 0], "
                       "radius: 0.1, speed: 1}\n"),
                 "emitters[1]: its casing, 0.204 m long behind its opening and 0.075 m thick, "
                 "overlaps that of emitter jet; move one of them"));
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 1"),
                       {R"(obstacles=[{"name":"post","shape":"box","min":[0.4,0.4,0.4],"max":)"
                        R"([0.45,0.6,0.6]}])"}),
                 "overlaps obstacle post at ("));
  CHECK(contains(error(jet("shape: disc, radius: 0.1, speed: 30"), {"solver.speed_limit=0.5"}),
                 "emitters[0].speed: is 30 m/s, above solver.speed_limit (12.5 m/s at this "
                 "time.step)"));
}

TEST_CASE("sinks and capacity: what does not go together is refused by name") {
  const std::string sink = "sinks: [{name: drain, min: [0, 0, 0], max: [0.1, 1, 0.1]}]\n";
  CHECK(parse_error(kScene + sink) == "no error");
  CHECK(contains(parse_error(kScene + sink, {"sinks.0.max=[0.1, -1, 0.1]"}),
                 "sinks[0].max: y is -1, not above sinks[0].min (0)"));
  CHECK(contains(parse_error(emitters(jet("shape: disc, radius: 0.1, speed: 1")) +
                             "sinks: [{name: d, min: [0.4, 0.4, 0.4], max: [1, 1, 1]}]\n"),
                 "sinks[0].min: the box holds a place in the casing of emitter jet, ("));
  CHECK(contains(parse_error(kScene, {"capacity=100"}),
                 "capacity: is given in a scene without emitters and sinks"));
  CHECK(contains(parse_error(kScene + sink, {"domain.periodic=[x]", "capacity=auto"}),
                 "domain.periodic: images beyond periodic faces are of a fixed number"));
  CHECK(contains(
      parse_error(kScene + sink, {R"(gauges=[{"name":"q","kind":"flow","center":[0.5,0.5,0.1],)"
                                  R"("normal":[1,0,0],"size":[1,0.2]}])",
                                  "capacity=100000"}),
      "capacity: limits the particles at a time, and a flow gauge follows all"));
}

TEST_CASE("emitters in two dimensions: the opening is a line in the plane") {
  const std::string flat =
      "dimensions: 2\ndomain: {min: [0, 0], max: [1, 1]}\nfluid: {spacing: 0.05}\n"
      "bodies: [{shape: block, min: [0, 0], max: [1, 0.2]}]\ntime: {step: 0.004, end: 0.5}\n";
  CHECK(parse_error(flat + "emitters: [{name: a, shape: disc, center: [0.5, 0.5], normal: [1, 0], "
                           "radius: 0.1, speed: 1}]\n") == "no error");
  CHECK(parse_error(flat + "emitters: [{name: a, shape: rectangle, center: [0.5, 0.5], normal: [1, "
                           "0], size: [0.2], speed: 1}]\n") == "no error");
  CHECK(contains(parse_error(flat + "emitters: [{name: a, shape: rectangle, center: [0.5, 0.5], "
                                    "normal: [1, 0], size: [0.2, 0.1], speed: 1}]\n"),
                 "emitters[0].size: has 2 numbers, expected the length of a line, [size]"));
  CHECK(contains(parse_error(flat + "emitters: [{name: a, shape: disc, center: [0.5, 0.5], normal: "
                                    "[1, 1, 0], radius: 0.1, speed: 1}]\n"),
                 "emitters[0].normal: its y component is 1"));
}

}  // namespace pbf::scene_test
