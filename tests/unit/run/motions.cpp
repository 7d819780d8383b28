// What runs make of motions before and between updates.
#include "lib/program/substep_lists.h"
#include "lib/run/guard.h"
#include "lib/run/step_control.h"
#include "lib/run/warnings.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// h = 0.2 m, steps of 0.01 s. A box that goes at `speed`, m/s.
Scene going(const std::string& speed, const std::string& more = "") {
  return parse(kMinimal +
               "obstacles: [{name: a, shape: box, min: [0.2, 0.2, 0.6], max: [0.4, 0.4, 0.8], "
               "motion: {kind: velocity, velocity: [" +
               speed + ", 0, 0]}}]\n" + more);
}
bool warns(const Scene& s) {
  for (const Warning& w : scene_warnings({s, "."}, 100))
    if (w.kind == "motion") return true;
  return false;
}

}  // namespace

TEST_CASE("an obstacle that moves by more than 0.4 h in a step is warned of") {
  CHECK_FALSE(warns(going("7.9")));
  CHECK(warns(going("8.1")));
  CHECK_FALSE(warns(going("8.1", "solver: {substeps: 2}\n")));
  Scene s = going("8.1");
  s.time.adaptive = AdaptiveTime{};
  CHECK_FALSE(warns(s));
}

TEST_CASE("adaptive steps follow obstacles and the tank, not only the fluid") {
  Scene s = going("8");
  s.time.adaptive = AdaptiveTime{};
  AdaptiveStep step(s);
  Diagnostics m;
  step.follow(m);
  CHECK(step.step(step.level()) <= 0.4 * 0.2 / 8 * (1 + 1e-9));
  Scene tank = parse(
      kMinimal + "tank_motion: {kind: sine, direction: [1, 0, 0], amplitude: 1, period: 0.1}\n");
  tank.time.adaptive = AdaptiveTime{};
  AdaptiveStep shaken(tank);
  shaken.follow(m);
  CHECK(shaken.level() > 0);
}

TEST_CASE("lists are made more often where an obstacle is fast") {
  const Scene slow = going("0.1", "solver: {substeps: 8}\n"),
              fast = going("80", "solver: {substeps: 8}\n");
  CHECK(lists_per_update(fast) > lists_per_update(slow));
}

TEST_CASE(
    "work: what moves adds to the energy without a rise, and its power is summed in between") {
  EnergyTrack track;
  WorkTrack work;
  Diagnostics m;
  m.energy = 10;
  track.follow(m);
  for (int k = 1; k <= 3; ++k) {
    m.time = 0.5 * k;
    m.power = 2;  // from 0 at once: 0.5 J in the first interval, then 1 J in each
    m.solid_work = 3;
    m.work = work.until(m);
    work.take(m);
    m.energy = 10 + m.work;
    m.kinetic_energy = m.energy;
    track.follow(m);
    CHECK(total_energy(m) == Approx(10));
  }
  CHECK(m.work == Approx(9 + 2.5));
  CHECK(m.energy_rise == 0);
  CHECK(m.energy_drift == Approx(0).margin(1e-15));
  m.energy += 1;
  track.follow(m);
  CHECK(m.energy_rise == Approx(0.1));
  // A checkpoint holds what is needed to go on.
  m.time = 2;
  CHECK(WorkTrack(track.history()).until(m) == Approx(work.until(m)));
}

}  // namespace pbf::scene_test
