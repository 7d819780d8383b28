// What a scene may say of sponges, and every error about them with its remedy.
#include "lib/scene/sponge.h"

#include <complex>

#include "lib/scene/sponge_waves.h"
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

TEST_CASE("a sponge reflects what linear theory of long waves says") {
  // Of a constant rate in closed form: e = cosh(g y), u = (i w/g) sinh(g y), y from the wall.
  for (const double rate : {0.0, 1.0, 8.0, 60.0})
    for (const double lengths : {0.1, 0.5, 1.7}) {
      const std::complex<double> iw(0, 2 * 3.14159265358979323846),
          g = std::sqrt(iw * (iw + rate)), e = std::cosh(g * lengths),
          u = iw / g * std::sinh(g * lengths);
      CAPTURE(rate, lengths);
      CHECK(sponge_reflection(lengths, rate, 0) ==
            Approx(std::abs(e - u) / std::abs(e + u)).margin(1e-6));
    }
  // Quadratic ones of 0.5 to 2 wavelengths.
  const double known[][2] = {{0.5, 0.05}, {0.75, 0.08}, {1, 0.02}, {1.5, 0.001}, {2, 0.002}};
  for (const auto& [lengths, share] : known)
    CHECK(sponge_reflection(lengths, 15, 2) == Approx(share).margin(0.005));
  CHECK(sponge_reflection(0, 15, 2) == 1);
  // Strong ones become walls, long and weak ones let nothing come back.
  CHECK(sponge_reflection(1, 1e6, 1) > 0.5);
  CHECK(sponge_reflection(1, 1e12, 1) <= 1);
  CHECK(sponge_reflection(340, 15, 2) < 1e-3);
  CHECK(sponge_reflection(1e6, 15, 2) < 1e-3);
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
