// The energy of fluid at rest against vessels whose filling is a formula.
#include "lib/program/energy_at_rest.h"

#include <cmath>

#include "lib/run/emit.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;

namespace {

double rest_of(const std::string& yaml) {
  const Scene s = scene_test::parse(yaml);
  return energy_at_rest(s, make_plan(s, count_particles(s, ".")));
}
/// 2 m x 0.5 m x 3 m, with 0.5 m^3 of water high up in it.
std::string vessel(const std::string& more) {
  return "domain: {min: [-1, 0, 5], max: [1, 0.5, 8]" + more +
         "fluid: {spacing: 0.05}\n"
         "bodies: [{shape: block, min: [-1, 0, 6.5], max: [0, 0.5, 7.5]}]\n"
         "time: {step: 0.01, end: 1}\n";
}
constexpr double kMass = 500;  // kg

}  // namespace

TEST_CASE("energy at rest: water in a box lies on its floor, wherever it starts") {
  // 0.5 m deep over 1 m^2.
  CHECK(rest_of(vessel("}\n")) == Approx(kMass * 9.81 * 0.25).epsilon(1e-3));
  CHECK(rest_of(vessel(", open: [z_max]}\n")) == Approx(kMass * 9.81 * 0.25).epsilon(1e-3));
  // Upwards: above the lowest corner of the box, which is then the upper face.
  CHECK(rest_of(vessel("}\ngravity: [0, 0, 9.81]\n")) == Approx(kMass * 9.81 * 0.25).epsilon(1e-3));
  // Against a side wall of 1.5 m^2: 1/3 m deep.
  CHECK(rest_of(vessel("}\ngravity: [-3, 0, 0]\n")) == Approx(kMass * 3 / 6).epsilon(1e-3));
}

TEST_CASE("energy at rest: water in a corner has a level surface") {
  // 0.02 m^2 in a plane, down along the diagonal: a triangle with legs of 0.2 m, whose centre is
  // 0.2/3 m from either wall. 0.1 m is the thickness.
  const double e = rest_of(
      "dimensions: 2\n"
      "domain: {min: [0, 0, 0], max: [1, 0.01, 1]}\n"
      "gravity: [-6, -0, -6]\n"
      "fluid: {spacing: 0.01}\n"
      "bodies: [{shape: block, min: [0.5, 0, 0.5], max: [0.7, 0.01, 0.6]}]\n"
      "time: {step: 0.001, end: 1}\n");
  CHECK(e == Approx(1000 * 0.02 * 0.01 * 2 * 6 * 0.2 / 3).epsilon(2e-3));
}

TEST_CASE("energy at rest: obstacles take room, and water lies around and above them") {
  // A block 0.25 m high stands on half of the floor: 0.125 m^3 beside it, the rest above both.
  const double e = rest_of(
      vessel("}\nobstacles: [{name: sill, shape: box, min: [0, 0, 5], max: [1, 0.5, 5.25]}]\n"));
  const double beside = 0.125, above = 0.375;
  CHECK(e == Approx(1000 * 9.81 * (beside * 0.125 + above * (0.25 + above / 2))).epsilon(3e-3));
}

TEST_CASE("energy at rest: without gravity, or where the fluid can run out, there is none") {
  CHECK(std::isnan(rest_of(vessel("}\ngravity: [0, 0, 0]\n"))));
  CHECK(std::isnan(rest_of(vessel(", open: [z_min]}\n"))));
  CHECK(std::isnan(rest_of(vessel(", open: [x_max]}\n"))));
  CHECK(std::isnan(rest_of(vessel(", open: [z_max]}\ngravity: [0, 0, 9.81]\n"))));
  CHECK(std::isnan(rest_of(vessel(", open: [x_min]}\ngravity: [-1, 0, -9]\n"))));
  CHECK_FALSE(std::isnan(rest_of(vessel(", open: [x_max]}\ngravity: [-1, 0, -9]\n"))));
}
