// The keys of viscosity and friction: what they mean, and what is refused with the remedy.
#include "lib/scene/viscosity.h"

#include <cmath>

#include "lib/program/time_levels.h"
#include "lib/scene/periodic.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

void is_refused_there(const std::vector<std::string>& set, const std::string& because) {
  CAPTURE(set);
  const std::string error = parse_error(kMinimal, set);
  CAPTURE(error);
  CHECK(contains(error, because));
}

/// nu in units of M h^2/dt, M by the sum over the square or cubic lattice with h = 2 d, by hand.
double lattice_moment(bool flat) {
  double second = 0, all = 0;
  for (int z = -2; z <= 2; ++z)
    for (int y = -2; y <= 2; ++y)
      for (int x = -2; x <= 2; ++x) {
        const double q = std::sqrt(double(x * x + y * y + z * z)) / 2;
        if (q >= 1 || (flat && y != 0)) continue;
        all += std::pow(1 - q, 3), second += std::pow(1 - q, 3) * z * z / 4.0;
      }
  return 0.5 * second / all;
}

}  // namespace

TEST_CASE("a kinematic viscosity alone is all the viscosity, in as many sweeps as its step needs") {
  const Scene s = parse(kMinimal, {"viscosity.kinematic=0.001"});
  CHECK(s.viscosity->xsph == 0);
  CHECK(kinematic_viscosity(s) == 0.001);
  CHECK(viscous_moment(s) == Approx(lattice_moment(false)).epsilon(1e-12));
  const double one = 0.01 / (lattice_moment(false) * 0.04);  // factor per m^2/s
  CHECK(viscous_sweeps(s).sweeps == 1);
  CHECK(viscous_sweeps(s).factor == Approx(0.001 * one));
  const Scene thick = parse(kMinimal, {"viscosity={kinematic: 0.5}"});
  CHECK(viscous_sweeps(thick).sweeps == int(std::ceil(0.5 * one)));
  CHECK(viscous_sweeps(thick).sweeps * viscous_sweeps(thick).factor == Approx(0.5 * one));
  CHECK(viscous_sweeps(thick).factor <= 1);
  // Walls act between sweeps, which are then half as strong.
  const Scene rough = parse(kMinimal, {"viscosity={kinematic: 0.5}", "domain.friction=1"});
  CHECK(viscous_sweeps(rough).factor <= 0.5);
  CHECK(viscous_sweeps(parse(kMinimal)).sweeps == 0);
  CHECK(viscous_sweeps(parse(kMinimal, {"viscosity.xsph=0"})).sweeps == 0);
  CHECK(viscous_sweeps(parse(kMinimal, {"viscosity={}"})).factor == 0.05);
}

TEST_CASE("XSPH stands for a viscosity that depends on step and spacing") {
  const Scene s = parse(kMinimal, {"viscosity.xsph=0.1"});
  CHECK(kinematic_viscosity(s) == Approx(0.1 * lattice_moment(false) * 0.04 / 0.01));
  CHECK(kinematic_viscosity(parse(kMinimal, {"viscosity.xsph=0.1", "time.step=0.005"})) ==
        Approx(2 * kinematic_viscosity(s)));
}

TEST_CASE("half the step has half the factor, with the same number of sweeps") {
  const Scene s = parse(kMinimal, {"viscosity.kinematic=0.5", "time.adaptive={}"});
  const int sweeps = viscous_sweeps(s).sweeps;
  CHECK(factor_of_sweep(scene_at_level(s, 2), sweeps) ==
        Approx(factor_of_sweep(s, sweeps) / 4).epsilon(1e-14));
}

TEST_CASE("the longest step of a viscosity is what its message says") {
  is_refused_there(
      {"viscosity.kinematic=50"},
      "viscosity.kinematic: 50 m^2/s moves momentum farther in time.step (0.01 s) than 64 "
      "sweeps over the neighbors reach; lower time.step to 0.00145 s, raise fluid.spacing, "
      "or lower it to 7.23 m^2/s");
  CHECK(parse_error(kMinimal, {"viscosity.kinematic=50", "time.step=0.00145"}) == "no error");
  CHECK(parse_error(kMinimal, {"viscosity.kinematic=7.23"}) == "no error");
  is_refused_there({"viscosity.kinematic=1e9"}, "than 64 sweeps");
  is_refused_there({"viscosity.kinematic=0"}, "is out of range, allowed: > 0");
  is_refused_there({"viscosity.kinematic=-1"}, "is out of range");
  CHECK(parse_error(kMinimal, {"viscosity.kinematic=1e-300"}) == "no error");
}

TEST_CASE("two viscosities, friction without one, and friction where no wall is are refused") {
  is_refused_there({"viscosity={kinematic: 0.001, xsph: 0.1}"},
                   "is all the viscosity there is, and viscosity.xsph is 0.1");
  CHECK(parse_error(kMinimal, {"viscosity={kinematic: 0.001, xsph: 0}"}) == "no error");
  is_refused_there({"domain.friction=1"}, "of which there is none; give viscosity");
  is_refused_there({"domain.friction=1", "viscosity.xsph=0"}, "of which there is none");
  is_refused_there({"obstacles=[{name: a, shape: sphere, center: [0.5, 0.5, 0.8], radius: 0.2, "
                    "friction: 0.5}]"},
                   "obstacles[0].friction: is 0.5, and walls hold fluid by its viscosity");
  const std::string nu = "viscosity.kinematic=0.001";
  is_refused_there({nu, "domain.friction=1.01"}, "out of range");
  is_refused_there({nu, "domain.friction=1", "domain.friction_on=[w_min]"},
                   "\"w_min\" is not one of");
  is_refused_there({nu, "domain.friction=1", "domain.friction_on=[z_max]", "domain.open=[z_max]"},
                   "z_max is no wall (domain.open)");
  is_refused_there({nu, "domain.friction=1", "domain.friction_on=[x_min]", "domain.periodic=[x]"},
                   "x_min is no wall (domain.periodic)");
  is_refused_there({nu, "domain.friction_on=[z_min]"}, "names faces, and domain.friction is 0");
  is_refused_there(
      {nu, "domain.friction=1", "domain.open=[x_min, x_max, y_min, y_max, z_min, z_max]"},
      "no face of the domain is a wall");
  is_refused_there({nu, "fluid.smoothing_ratio=1.2", "fluid.mass=1"}, "with so few neighbors");
}

TEST_CASE("friction is that of the named faces that are walls, or of all walls") {
  const Scene all = parse(kMinimal, {"viscosity={}", "domain.friction=0.5", "domain.open=[z_max]"});
  CHECK(all.domain.friction_of(0) == 0.5);
  CHECK(all.domain.friction_of(5) == 0);
  const Scene floor =
      parse(kMinimal, {"viscosity={}", "domain.friction=1", "domain.friction_on=[z_min]"});
  CHECK(floor.domain.friction_of(4) == 1);
  CHECK(floor.domain.friction_of(0) == 0);
  CHECK(has_friction(floor));
  CHECK_FALSE(has_friction(parse(kMinimal, {"viscosity={}"})));
}

TEST_CASE("gravity drives fluid along a periodic axis if something has friction") {
  const std::vector<std::string> channel{"domain.periodic=[x]", "gravity=[0.1, 0, -9.81]"};
  is_refused_there(channel, "would fall for ever; give friction to walls or obstacles");
  std::vector<std::string> rough = channel;
  rough.insert(rough.end(), {"viscosity.kinematic=0.001", "domain.friction=1"});
  CHECK(parse_error(kMinimal, rough) == "no error");
  CHECK(has_drive(parse(kMinimal, rough)));
  CHECK_FALSE(has_drive(parse(kMinimal, {"domain.periodic=[x]"})));
  rough.emplace_back("settle={}");
  is_refused_there(rough, "settle.gravity: its component along x is 0.1");
  rough.back() = "settle={gravity: [0, 0, -9.81]}";
  CHECK(parse_error(kMinimal, rough) == "no error");
}

}  // namespace pbf::scene_test
