// Time steps of second order against motions that are known exactly, and against the same motion
// seen from elsewhere.
#include <algorithm>
#include <cmath>

#include "lib/exec/make_solver.h"
#include "lib/run/emit.h"
#include "lib/scene/vector3.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;

namespace {

struct Run {
  Scene scene;
  std::unique_ptr<Solver> solver;
  double mass = 0;  // kg
  explicit Run(const std::string& yaml, std::vector<std::string> set = {},
               Double3 faster = {0, 0, 0}) {
    set.push_back("threads=1");
    set.push_back("precision=double");
    scene = scene_test::parse(yaml, std::move(set));
    Particles particles = emit_particles(scene, ".");
    for (Double3& v : particles.velocity)
      for (std::size_t k = 0; k < 3; ++k) v[k] += faster[k];
    const Plan plan = make_plan(scene, std::int64_t(particles.size()));
    mass = plan.mass * double(particles.size());
    solver = make_solver(scene, plan, std::move(particles));
  }
  Diagnostics after(int updates, const StepOptions& options = {}) {
    solver->step(updates, options);
    return solver->diagnose();
  }
};

const std::string kFall =
    "domain: {min: [0, 0, 0], max: [2, 2, 40]}\n"
    "fluid: {spacing: 0.1}\n"
    "bodies: [{shape: sphere, center: [1, 1, 39], radius: 0.35, velocity: [0, 0, 1]}]\n"
    "time: {step: 0.01, end: 1}\n";

/// A disc of 2 m that one flow stretches and squeezes: v = (a x, -a z).
const std::string kDrop =
    "dimensions: 2\n"
    "domain: {min: [-4, -4], max: [4, 4]}\n"
    "gravity: [0, 0]\n"
    "fluid: {spacing: 0.1}\n"
    "bodies: [{shape: sphere, center: [0, 0], radius: 1}]\n"
    "time: {step: 0.004, end: 1}\n";

Particles stretched(const Scene& s) {
  Particles p = emit_particles(s, ".");
  for (std::size_t i = 0; i < p.size(); ++i)
    p.velocity[i] = {1.5 * p.position[i][0], 0, -1.5 * p.position[i][2]};
  return p;
}
/// The share of the kinetic energy that is left when the flow has gone on for 0.3 s. Without
/// viscosity and gravity it is constant.
double kept(const std::string& order) {
  const Scene s = scene_test::parse(kDrop, {"time.order=" + order, "threads=1"});
  const Particles p = stretched(s);
  const auto solver = make_solver(s, make_plan(s, std::int64_t(p.size())), p);
  const double before = solver->diagnose().kinetic_energy;
  solver->step(75);
  return solver->diagnose().kinetic_energy / before;
}

}  // namespace

TEST_CASE("second order: free fall is exact with any step, also where its length changes") {
  const auto height = [](const std::string& order, bool changes) {
    Run run(kFall, {"time.order=" + order, "solver.prestabilize=false"});
    const double z0 = run.solver->diagnose().center_of_mass[2];
    for (int k = 0; k < 5; ++k) {
      StepOptions options;
      options.level = changes ? k % 3 : 0;
      run.solver->step(4, options);
    }
    return run.solver->diagnose().center_of_mass[2] - z0;
  };
  const double t = 0.2, exact = t - 0.5 * 9.81 * t * t;
  for (const bool changes : {false, true}) {
    CHECK(height("2", changes) == Approx(exact).margin(1e-10));
    CHECK(std::fabs(height("1", changes) - exact) > 1e-3);
  }
}

TEST_CASE("second order: the energy of what falls or is thrown up is that of the start") {
  for (const char* up : {"0", "2", "-4"}) {
    const auto change = [&](const std::string& order) {
      Run run(kFall, {"time.order=" + order, "solver.prestabilize=false",
                      std::string("bodies[0].velocity=[0, 0, ") + up + "]"});
      const Diagnostics first = run.solver->diagnose(), last = run.after(20);
      return (last.energy - first.energy) / run.mass;  // J/kg
    };
    CAPTURE(up);
    // The mean height of the ends of a step is g dt^2/8 below that of its middle.
    CHECK(change("2") == Approx(-9.81 * 9.81 * 1e-4 / 8).epsilon(1e-6));
    CHECK(std::fabs(change("1")) > 0.01);
  }
}

TEST_CASE("second order: a drop that is stretched keeps its energy") {
  const double first = kept("1"), second = kept("2");
  CAPTURE(first, second);
  CHECK(second > 0.993);
  CHECK(1 - second < 0.5 * (1 - first));
}

TEST_CASE("second order: a common velocity changes nothing but the place") {
  const std::string drops =
      "domain: {min: [-3, -3, -3], max: [3, 3, 3], open: [x_min, x_max, y_min, y_max, z_min, "
      "z_max]}\n"
      "gravity: [0, 0, 0]\n"
      "fluid: {spacing: 0.1}\n"
      "bodies:\n"
      "  - {shape: sphere, center: [-0.5, 0.03, 0], radius: 0.4, velocity: [2, 0, 0]}\n"
      "  - {shape: sphere, center: [0.5, 0, 0.05], radius: 0.4, velocity: [-2, 0, 0]}\n"
      "time: {step: 0.005, end: 1, order: 2}\n";
  const Double3 wind{1, -0.5, 0.75};
  Run still(drops), moved(drops, {}, wind);
  const Diagnostics first = still.solver->diagnose();
  const auto momentum = [](const Diagnostics& m) {
    return Double3{m.momentum[0], m.momentum[1], m.momentum[2]};
  };
  const double mass = length(momentum(first) - momentum(moved.solver->diagnose())) / length(wind);
  const Diagnostics a = still.after(60), b = moved.after(60);
  CHECK(a.kinetic_energy < 0.95 * first.kinetic_energy);  // they have met
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(a.momentum[k] == Approx(first.momentum[k]).margin(1e-9 * mass));
    CHECK(b.momentum[k] == Approx(first.momentum[k] + mass * wind[k]).epsilon(1e-9));
    CHECK(b.center_of_mass[k] - a.center_of_mass[k] == Approx(0.3 * wind[k]).epsilon(1e-9));
  }
  const double of_wind = 0.5 * mass * dot(wind, wind) + dot(momentum(a), wind);
  // An impact enlarges roundings.
  CHECK(b.kinetic_energy - of_wind == Approx(a.kinetic_energy).epsilon(1e-7));
}

TEST_CASE("second order: velocities without the last push are a state of their own") {
  const auto state = [](const std::string& order) {
    Run run(kFall, {"time.order=" + order});
    run.solver->step(2);
    return run.solver->state();
  };
  const SolverState first = state("1"), second = state("2");
  for (const char* name : {"free velocity", "step length"}) {
    CHECK_FALSE(first.find(name));
    CHECK(second.find(name));
  }
  CHECK(second.find("step length")->values == std::vector<double>{0.01});
  // Nothing pushes in free fall but rounding.
  const std::vector<double>& free = second.find("free velocity")->values;
  REQUIRE(free.size() == second.velocity.size());
  double most = 0;
  for (std::size_t k = 0; k < free.size(); ++k)
    most = std::max(most, std::fabs(free[k] - second.velocity[k]));
  CHECK(most < 1e-12);
}
