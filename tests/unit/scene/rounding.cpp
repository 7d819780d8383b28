// Scenes whose motion would be rounded away are refused, others are not.
#include "lib/scene/rounding.h"

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "lib/exec/make_solver.h"
#include "lib/program/plan.h"
#include "lib/run/emit.h"
#include "lib/solver/solver.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// One particle in a box 100 h high, h = 0.1 m, g = 10 m/s^2.
std::string falling(const std::string& step, const std::string& end, const std::string& more = "") {
  return "domain: {min: [0, 0, 0], max: [10, 1, 10]}\nfluid: {spacing: 0.05}\n"
         "bodies: [{shape: block, min: [5, 0.5, 9], max: [5.05, 0.55, 9.05]}]\n"
         "gravity: [0, 0, -10]\ntime: {step: " +
         step + ", end: " + end + "}\n" + more;
}

/// How far the particle falls, over g dt^2 n (n + 1)/2.
double share_fallen(const Scene& s) {
  const std::int64_t n = count_particles(s, "");
  auto solver = make_solver(s, make_plan(s, n), emit_particles(s, ""));
  const double start = solver->diagnose().center_of_mass[2];
  const int updates = int(std::lround(s.time.end / s.time.step));
  solver->step(updates);
  const double g = -s.gravity[2], dt = s.time.step;
  return (start - solver->diagnose().center_of_mass[2]) /
         (g * dt * dt * updates * (updates + 1) / 2);
}

}  // namespace

TEST_CASE("a step so short that float would hold a falling particle is refused with its remedy") {
  const std::string error = parse_error(falling("1.0e-6", "0.04"));
  CHECK(contains(error, "2 scene.yaml:5:"));
  CHECK(contains(error, ": time.step: in float up to 0.0728 h of a motion over 0.08 h would be"));
  CHECK(contains(error, "give precision: double, or raise time.step"));
  CHECK(parse_error(falling("1.0e-6", "0.04", "precision: double\n")) == "no error");
  CHECK(parse_error(falling("1.0e-6", "0.04"), {"precision=double"}) == "no error");
  CHECK(contains(parse_error(falling("1.0e-4", "0.04"), {"solver.substeps=100"}),
                 "raise time.step or lower solver.substeps"));
  // The same fall in a box 16 times smaller, and without gravity or motion.
  CHECK(parse_error(falling("1.0e-6", "0.04"), {"domain.min=[4,0,6]", "domain.max=[6,1,10]"}) !=
        "no error");
  CHECK(parse_error(falling("1.0e-6", "0.04"), {"gravity=[0,0,0]"}) == "no error");
  // So short a run that nobody sees what is lost.
  CHECK(parse_error(falling("1.0e-6", "1.0e-3")) == "no error");
}

TEST_CASE("how long a box may be depends on the precision alone, not on the number of its cells") {
  // h = 1 mm, at rest: nothing but the box counts. Numbers from 2^17 h on are more than h/128
  // apart in float, from 2^46 h on in double. 2^31 cells are passed by the second edge.
  const auto error = [](double edge, const std::string& precision, bool cube) {
    std::ostringstream max;
    max << std::setprecision(17) << "domain.max=[" << edge << "," << (cube ? edge : 1) << ","
        << (cube ? edge : 10) << "]";
    return parse_error(falling("1.0e-3", "0.04"), {"gravity=[0,0,0]", "fluid.spacing=5e-4",
                                                   max.str(), "precision=" + precision});
  };
  for (const bool cube : {false, true})
    for (const auto& [precision, most] : {std::pair{"float", 17}, {"double", 46}}) {
      const double limit = std::ldexp(1e-3, most);
      CAPTURE(cube, precision);
      CHECK(error(limit * (1 - 1e-9), precision, cube) == "no error");
      CHECK(contains(error(limit * (1 + 1e-9), precision, cube),
                     "domain.max: the box is so long that positions in "));
    }
}

// Positions are as coarse as the box is high. Along x and y it is 4 h wide, so that half a million
// steps visit few cells; nothing moves there.
TEST_CASE("a fall just within the limit is right within 2 %, far beyond it is not", "[slow]") {
  const std::vector<std::string> shaft{"domain.min=[4.8,0.3,0]", "domain.max=[5.2,0.7,10]"};
  for (const char* end : {"0.04", "0.1", "0.4"}) {
    Scene s = parse(falling("1.0e-3", end), shaft);
    s.threads = 1;
    s.time.step = 1e-8;
    const auto refused = [&] {
      const Rounding r = rounding_of(s);
      return r.lost > kLeastLoss || r.slow > kLargestLoss;
    };
    while (refused()) s.time.step *= 1.1;
    CAPTURE(end, s.time.step);
    CHECK(share_fallen(s) == Approx(1).epsilon(0.02));
    s.time.step /= 1.1;
    CHECK(refused());
  }
  Scene s = parse(falling("1.0e-3", "0.04"), shaft);
  s.threads = 1;
  s.time.step = 1e-6;
  CHECK(share_fallen(s) < 0.2);  // why it is refused
}

TEST_CASE("so many steps that rounding slows a fall are refused, in double none that can be run") {
  CHECK(contains(parse_error(falling("2.0e-6", "2"), {"domain.max=[10,1,40]"}),
                 "time.step: makes so many steps in a fall that rounding in float would take "));
  CHECK(parse_error(falling("1.0e-12", "2.0e-3"), {"precision=double"}) == "no error");
}

TEST_CASE("without gravity the bodies' velocities count") {
  const std::vector<std::string> drift{"gravity=[0,0,0]", "bodies[0].velocity=[0,0,-0.1]"};
  CHECK(parse_error(falling("1.0e-3", "1"), drift) == "no error");
  CHECK(contains(parse_error(falling("1.0e-6", "1"), drift), "time.step: in float up to "));
}

TEST_CASE("a box too long for float is refused, with double it is fine") {
  const std::string more = "solver: {iterations: 1}\n";
  CHECK(parse_error(falling("1.0e-3", "1", more), {"domain.max=[13000,1,10]"}) == "no error");
  const std::string error = parse_error(falling("1.0e-3", "1", more), {"domain.max=[1.0e+5,1,10]"});
  CHECK(
      contains(error, "domain.max: the box is so long that positions in float are 0.0625 h apart"));
  CHECK(contains(error, "give precision: double, or make the domain smaller"));
  CHECK(parse_error(falling("1.0e-3", "1", more),
                    {"domain.max=[1.0e+5,1,10]", "precision=double"}) == "no error");
}

}  // namespace pbf::scene_test
