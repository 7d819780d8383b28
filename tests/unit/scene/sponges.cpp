// What a scene may say of sponges, and every error about them with its remedy.
#include "lib/scene/sponge.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// The zones of kMinimal, whose domain is a cube of edge 1 m.
std::string sponge_error(const std::string& zones, const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"damping=[" + zones + "]"};
  set.insert(set.end(), more.begin(), more.end());
  return parse_error(kMinimal, set);
}
std::string zone(const std::string& more, const std::string& name = "end") {
  return "{name: " + name + ", min: [0.5, 0, 0], max: [1, 1, 1]" + more + "}";
}

const std::string kPaddle =
    "obstacles=[{name: p, shape: box, min: [0, 0, 0], max: [0.1, 1, 1], motion: {kind: sine, "
    "direction: [1, 0, 0], amplitude: 0.01, period: 3}}]";

}  // namespace

TEST_CASE("a sponge without a rate has that of the period of what oscillates") {
  const Scene s = parse(kMinimal, {"damping=[" + zone("") + "]", kPaddle});
  CHECK(sponge_rate(s, s.damping[0]) == Approx(5));
  CHECK(s.damping[0].profile == 2);
  CHECK(damps(s.damping[0], 1));
  CHECK(parse(resolved_yaml(s)) == s);
  const Scene given = parse(kMinimal, {"damping=[" + zone(", rate: 7, axes: [x, z]") + "]"});
  CHECK(sponge_rate(given, given.damping[0]) == 7);
  CHECK_FALSE(damps(given.damping[0], 1));
}

TEST_CASE("each mistake in a sponge is named with its remedy") {
  const auto says = [](const std::string& error, const std::string& part) {
    CAPTURE(error);
    CHECK(contains(error, part));
  };
  says(sponge_error(zone("")), "damping[0].rate: auto is 15 over the period");
  says(sponge_error(zone(", rate: -1")), "damping[0].rate");
  says(sponge_error(zone(", rate: 1, toward: right")), "damping[0].toward");
  says(sponge_error(zone(", rate: 1, profile: 5")), "damping[0].profile");
  says(sponge_error(zone(", rate: 1, axes: []")), "damping[0].axes: is empty");
  says(sponge_error(zone(", rate: 1, axes: [w]")), "damping[0].axes");
  says(sponge_error("{name: a, min: [0, 0, 0], max: [1, 0, 1], rate: 1}"), "the box is empty");
  says(sponge_error("{name: a, min: [3, 0, 0], max: [4, 1, 1], rate: 1}"),
       "the zone lies outside the domain along x");
  says(sponge_error(zone(", rate: 1") + "," + zone(", rate: 1")), "is also the name of damping[0]");
  std::string nine;
  for (int k = 0; k < 9; ++k) nine += (k ? "," : "") + zone(", rate: 1", "z" + std::to_string(k));
  says(sponge_error(nine), "is the 9th zone, at most 8 are possible");
}

}  // namespace pbf::scene_test
