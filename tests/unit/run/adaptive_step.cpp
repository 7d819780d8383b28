// The choice of the step's level: a function of the fastest speed and the greatest acceleration.
#include "lib/run/step_control.h"

#include <cmath>
#include <limits>

#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// step 0.01 s, h = 0.2 m, g = 10 m/s^2: the longest step at rest is 0.25 sqrt(0.02) = 0.035 s.
Scene adaptive(const std::string& keys = "{}") {
  return parse(
      "domain: {min: [0, 0, 0], max: [1, 1, 1]}\nfluid: {spacing: 0.1}\n"
      "bodies: [{shape: block, min: [0, 0, 0], max: [1, 1, 0.5]}]\n"
      "gravity: [0, 0, -10]\nmeasure_every: 5\n"
      "time: {step: 0.01, end: 1, adaptive: " +
      keys + "}\n");
}

Diagnostics at(std::int64_t update, double speed) {
  Diagnostics m;
  m.update = update;
  m.time = 0.01 * double(update);
  m.speed_max = speed;
  return m;
}

}  // namespace

TEST_CASE("step levels: as many as step_min allows, 6 by default, none without time.adaptive") {
  CHECK(finest_level(adaptive()) == 6);
  CHECK(finest_level(adaptive("on")) == 6);
  CHECK(finest_level(adaptive("off")) == 0);
  CHECK(finest_level(adaptive("{step_min: 0.01}")) == 0);
  CHECK(finest_level(adaptive("{step_min: 0.005}")) == 1);
  CHECK(finest_level(adaptive("{step_min: 0.0051}")) == 0);
  CHECK(finest_level(adaptive("{step_min: 0.00125}")) == 3);
}

TEST_CASE("step levels: a scene at a level has the step and what goes with it, and no more") {
  Scene s = adaptive();
  s.solver.velocity_damping = 0.9;
  s.solver.speed_limit = 0.8;
  s.viscosity = Viscosity{0.4};
  s.vorticity = Vorticity{3};
  s.tensile = Tensile{0.016, 0.2, 6};
  CHECK(scene_at_level(s, 0) == s);
  Scene two = scene_at_level(s, 2);
  CHECK(two.time.step == 0.0025);
  CHECK(std::pow(two.solver.velocity_damping, 4) == Approx(0.9).epsilon(1e-14));
  CHECK(two.solver.speed_limit / two.time.step == s.solver.speed_limit / s.time.step);
  CHECK(two.viscosity->xsph == 0.1);
  CHECK(two.tensile->k == 0.001);
  two.time.step = s.time.step;
  two.solver.velocity_damping = 0.9;
  two.solver.speed_limit = 0.8;
  two.viscosity->xsph = 0.4;
  two.tensile->k = 0.016;
  CHECK(two == s);
}

TEST_CASE("step levels: what is off stays off at every level, and only numbers are scaled") {
  Scene s = adaptive();
  const Scene three = scene_at_level(s, 3);
  CHECK_FALSE(three.viscosity);
  CHECK_FALSE(three.tensile);
  s.time.step = three.time.step;  // without damping and limit nothing else has a scale
  CHECK(three == s);
}

TEST_CASE("longest step: the smaller of cfl h/v and force sqrt(h/a), no limit from what is zero") {
  const Scene s = adaptive("{cfl: 0.5, force: 0.1}");
  CHECK(longest_step(s, 20, 0) == Approx(0.5 * 0.2 / 20));
  CHECK(longest_step(s, 0, 5) == Approx(0.1 * std::sqrt(0.2 / 5)));
  CHECK(longest_step(s, 20, 5) == Approx(0.005));
  CHECK(longest_step(s, 1, 50000) == Approx(0.1 * 0.002));
  CHECK(std::isinf(longest_step(s, 0, 0)));
}

TEST_CASE("next level: finer as far as needed at once, coarser by one and with room to spare") {
  const Scene s = adaptive();  // steps 0.01, 0.005, 0.0025, ... 0.00015625
  CHECK(next_level(s, 0, 0.01, true) == 0);
  CHECK(next_level(s, 0, 0.0099, true) == 1);
  CHECK(next_level(s, 0, 0.0013, true) == 3);
  CHECK(next_level(s, 2, 0.0013, true) == 3);
  CHECK(next_level(s, 0, 1e-9, true) == 6);
  CHECK(next_level(s, 0, 0, true) == 6);
  CHECK(next_level(s, 3, 1e9, true) == 2);
  CHECK(next_level(s, 3, 0.005, true) == 2);   // twice the coarser step
  CHECK(next_level(s, 3, 0.0049, true) == 3);  // it would do, but not with a margin of 2
  CHECK(next_level(s, 3, 0.00125, true) == 3);
  CHECK(next_level(s, 3, 1e9, false) == 3);
  CHECK(next_level(s, 6, 1e-9, true) == 6);
}

TEST_CASE("adaptive step: the fastest speed, and how fast it grows, choose the step") {
  AdaptiveStep a(adaptive());
  CHECK_FALSE(a.follow(at(0, 0)));
  CHECK(a.level() == 0);
  CHECK_FALSE(a.follow(at(5, 1)));         // 20 m/s^2: 0.025 s will do
  const auto line = a.follow(at(10, 13));  // cfl: 0.0062 s; 240 m/s^2: 0.0072 s
  REQUIRE(line);
  CHECK(a.level() == 1);
  CHECK(*line ==
        "update 10, 0.1 s: step 0.005 s (was 0.01): v_max dt 0.65 h, dt sqrt(a/h) 0.346 "
        "before");
  CHECK(a.step(a.level()) == 0.005);
  CHECK_FALSE(a.follow(at(15, 5)));  // cfl: 0.016 s, without a margin of 2
  REQUIRE(a.follow(at(20, 3.9)));    // 0.0205 s
  CHECK(a.level() == 0);
  REQUIRE(a.follow(at(25, 200)));
  CHECK(a.level() == 5);  // 0.4 0.2/200 = 0.0004 s
  CHECK(a.history().changes == 3);
  CHECK(a.updates_at_levels(40) == std::vector<std::int64_t>{15, 10, 0, 0, 0, 15, 0});
}

TEST_CASE("adaptive step: measures that ask for less than the shortest step are counted") {
  AdaptiveStep a(adaptive("{step_min: 0.005}"));
  REQUIRE(a.follow(at(0, 1000)));
  CHECK(a.level() == 1);
  CHECK_FALSE(a.follow(at(5, 1000)));
  CHECK_FALSE(a.follow(at(10, 14)));
  CHECK(a.history().floor == 3);  // the third asks for it by the deceleration
}

TEST_CASE("adaptive step: after an alarm no coarser step for 8 measures, then for 16, 32, ...") {
  AdaptiveStep a(adaptive());
  std::int64_t update = 0;
  const auto measures_until_coarser = [&] {
    int n = 0;
    for (const int level = a.level(); a.level() == level; ++n) a.follow(at(update += 5, 0));
    return n;
  };
  for (const int expected : {8, 16, 32, 64}) {
    REQUIRE(a.refine("energy", at(update + 5, 0), update));
    CHECK(a.level() == 1);
    CHECK(measures_until_coarser() == expected);
    CHECK(a.level() == 0);
  }
  CHECK(a.history().repeats == 4);
}

TEST_CASE("adaptive step: a coarser step that the criteria take back was tried too early, too") {
  AdaptiveStep a(adaptive());
  a.follow(at(0, 15));
  REQUIRE(a.level() == 1);
  a.follow(at(5, 3));  // slows down at 240 m/s^2
  a.follow(at(10, 3));
  REQUIRE(a.level() == 0);
  a.follow(at(15, 15));
  REQUIRE(a.level() == 1);
  int n = 0;
  for (std::int64_t u = 20; a.level() == 1; u += 5, ++n) a.follow(at(u, 3));
  CHECK(n == 16);
}

TEST_CASE("adaptive step: an alarm at the shortest step is left to the guard") {
  AdaptiveStep a(adaptive("{step_min: 0.0025}"));
  const auto line = a.refine("speed", at(15, 7), 10);
  REQUIRE(line);
  CHECK(*line ==
        "update 15, 0.15 s: alarm of the guard (speed), back to update 10: step 0.005 s "
        "(was 0.01)");
  REQUIRE(a.refine("speed", at(15, 7), 10));
  CHECK_FALSE(a.refine("speed", at(15, 7), 10));
  CHECK(a.level() == 2);
  CHECK(a.history().repeats == 2);
}

TEST_CASE("adaptive step: one that goes on from its history chooses as the one before would") {
  AdaptiveStep a(adaptive());
  a.follow(at(0, 30));
  a.refine("energy", at(5, 1), 0);
  for (std::int64_t u = 5; u < 300; u += 5) {
    AdaptiveStep b(adaptive(), a.history());
    const Diagnostics m = at(u, std::fmod(double(u * u), 23));
    CHECK(a.follow(m) == b.follow(m));
    CHECK(a.level() == b.level());
  }
}

}  // namespace pbf::scene_test
