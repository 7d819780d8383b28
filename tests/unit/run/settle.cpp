// Starts that settle before time 0.
#include "lib/run/settle.h"

#include <cmath>

#include "lib/base/error.h"
#include "lib/program/settling.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// A tank in two dimensions, 1 m long, 0.2 m deep, whose fluid is a square lattice.
std::string tank(const std::string& settle) {
  return "dimensions: 2\n"
         "domain: {min: [0, 0], max: [1, 0.4]}\n"
         "fluid: {spacing: 0.02}\n"
         "bodies: [{shape: block, min: [0, 0], max: [1, 0.2]}]\n"
         "time: {step: auto, end: 1}\n"
         "threads: 1\n" +
         settle;
}

Start settled(const std::string& yaml, const std::vector<std::string>& set = {}) {
  Start start = prepare(parse(yaml, set), ".");
  CHECK(settle(start));
  return start;
}

Double3 middle(const Particles& p) {
  Double3 m{};
  for (const Double3& x : p.position)
    for (std::size_t k = 0; k < 3; ++k) m[k] += x[k] / double(p.size());
  return m;
}

/// J, the largest kinetic energy in the first half second.
double largest_kinetic(Start& start) {
  const auto solver = solver_of(start);
  double most = 0;
  for (int k = 0; k < 50; ++k) {
    solver->step(std::max(1, int(0.01 / start.scene().time.step)));
    most = std::max(most, solver->diagnose().kinetic_energy);
  }
  return most;
}

}  // namespace

TEST_CASE("settle: the run begins as calm as fluid at rest is", "[slow]") {
  Start rough = prepare(parse(tank("")), ".");
  const double before = largest_kinetic(rough);
  Start calm = prepare(parse(tank("settle: {duration: 2}\n")), ".");
  CHECK(largest_kinetic(calm) < 0.1 * before);
  REQUIRE(calm.notes.size() == 1);
  CHECK(calm.notes[0].find("settled for 2 s before time 0") != std::string::npos);
  CHECK(calm.warnings.empty());
}

TEST_CASE("settle: tilted gravity leaves a level of that tilt", "[slow]") {
  const double slope = 0.1;
  const Start start = settled(tank("settle: {duration: 3, gravity: [0.981, -9.81]}\n"));
  // Of a wedge of fluid over a floor of length 1 m, 0.2 m deep on average.
  const double shift = slope * 1.0 * 1.0 / (12 * 0.2);
  CHECK(middle(start.particles)[0] - 0.5 == Approx(shift).epsilon(0.1));
}

TEST_CASE("settle: a tank that begins tilted has a level that is horizontal in space", "[slow]") {
  const std::string motion =
      "tank_motion: {kind: sine, axis: [0, 1, 0], amplitude: 5, period: 2, phase: 90}\n";
  const Start start = settled(tank("settle: {duration: 3}\n" + motion));
  const double shift = std::tan(5 * 3.14159265358979 / 180) / (12 * 0.2);
  CHECK(std::fabs(middle(start.particles)[0] - 0.5) == Approx(shift).epsilon(0.1));
  // A turn about y from z to x lowers the side of large x.
  const Scene s = settling_scene(start.scene());
  CHECK(s.gravity[0] * (middle(start.particles)[0] - 0.5) > 0);
}

TEST_CASE("settle: particles keep their velocities and numbers") {
  const Start start = settled(tank("settle: {duration: 0.5}\n"), {"bodies.0.velocity=[0.3,0.1]"});
  for (const Double3& v : start.particles.velocity) CHECK(v == Double3{0.3, 0, 0.1});
  CHECK(start.particles.size() == 500);
}

TEST_CASE("settle: obstacles stand where they are when the run begins") {
  const std::string gate =
      "obstacles:\n"
      "  - {name: gate, shape: box, min: [0.5, 0], max: [0.54, 0.4], motion: {kind: velocity, "
      "velocity: [0, 2]}}\n";
  const Start start = settled(tank("settle: {duration: 1}\n" + gate),
                              {"bodies.0.max=[0.5,0.2]", "time.motion_begin=0"});
  double farthest = 0;
  for (const Double3& x : start.particles.position) farthest = std::max(farthest, x[0]);
  CHECK(farthest < 0.5);
  CHECK(farthest > 0.47);
}

TEST_CASE("settle: the same bits on one thread and on two") {
  const Start one = settled(tank("settle: {duration: 0.3}\n"), {"threads=1"});
  const Start two = settled(tank("settle: {duration: 0.3}\n"), {"threads=2"});
  CHECK(one.particles.position == two.particles.position);
}

TEST_CASE("settle: it tells how far it is, and stops when it is asked to") {
  Start start = prepare(parse(tank("settle: {duration: 20}\n")), ".");
  int lines = 0;
  CHECK_FALSE(settle(
      start, [&](const std::string&) { ++lines; }, [&] { return lines > 3; }));
  CHECK(lines >= 3);
}

TEST_CASE("settle: what has not come to rest is warned of") {
  Start start = prepare(
      parse(tank("settle: {duration: 0.1}\n"), {"bodies.0.min=[0,0.15]", "bodies.0.max=[1,0.3]"}),
      ".");
  CHECK(settle(start));
  REQUIRE(start.warnings.size() == 1);
  CHECK(start.warnings[0].kind == "unsettled");
  CHECK(start.warnings[0].text.find("give a longer settle.duration") != std::string::npos);
}

TEST_CASE(
    "settle: the scene is one without what the run records, and with a step that is allowed") {
  const Scene s = parse(tank("settle: {duration: 2}\n"
                             "gauges: [{name: level, kind: level, at: [0.5]}]\n"
                             "output: {every: 0.1}\n"),
                        {"time.step=0.05", "time.adaptive=on", "domain.loads=true"});
  const Scene calm = settling_scene(s);
  CHECK(calm.gauges.empty());
  CHECK_FALSE(
      (calm.output || calm.guard || calm.domain.loads || calm.settle || calm.time.adaptive));
  CHECK(calm.time.step <= s.time.adaptive->force * std::sqrt(s.h() / 9.81));
  CHECK(calm.time.step > 0.4 * s.time.adaptive->force * std::sqrt(s.h() / 9.81));
  CHECK(settling_updates(s) == std::llround(2 / calm.time.step));
  // The velocity falls by exp(-10).
  CHECK(std::pow(calm.solver.velocity_damping, double(settling_updates(s))) ==
        Approx(std::exp(-10.0)).epsilon(1e-6));
  CHECK(settling_updates(parse(tank(""))) == 0);
}

TEST_CASE("settle: without gravity, and shorter than a step, it is refused") {
  const auto error = [](const std::string& settle, const std::vector<std::string>& set) {
    try {
      parse(tank(settle), set);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(error("settle: {duration: 1}\n", {"gravity=0", "time.step=0.002"})
            .find("settle.duration: without gravity nothing "
                  "settles; give settle.gravity") != std::string::npos);
  CHECK(error("settle: {duration: 1, gravity: [0, -9.81]}\n", {"gravity=0", "time.step=0.002"})
            .empty());
  CHECK(error("settle: {duration: 1e-5}\n", {}).find("below time.step") != std::string::npos);
  CHECK(error("settle: {duration: 1, gravity: [0, 1, -9.81]}\n", {}).find("dimensions: 2") !=
        std::string::npos);
}

}  // namespace pbf::scene_test
