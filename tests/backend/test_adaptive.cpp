// Updates of several steps (time.adaptive), and what an alarm does to them.
#include <algorithm>
#include <cmath>

#include "lib/base/error.h"
#include "lib/run/monitor.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"
#include "tests/support/guard_check.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::same_particles;

namespace {

Case everything_adaptive() {
  Case c = here(jittered_block(10, 9, 11, 0.3, 0.4));
  c.scene.domain.max[0] += 0.1;
  c.scene.time.adaptive = pbf::AdaptiveTime{};
  c.scene.solver.velocity_damping = 0.97;
  c.scene.solver.substeps = 2;
  c.scene.tensile = pbf::Tensile{0.016, 0.3, 4};
  c.scene.viscosity = pbf::Viscosity{0.2};
  c.scene.vorticity = pbf::Vorticity{5};
  return c;
}

/// A pool with one iteration and five times the step that it can bear; it sinks into itself, and
/// the energy of that throws it up.
Case unstable_pool() {
  Case c = here(jittered_block(8, 8, 12, 0, 0));
  const pbf::Double3 low = c.scene.domain.min;
  c.scene.fluid.spacing = 0.05;
  c.scene.domain = {{0, 0, 0}, {0.4, 0.4, 1.2}, {}};
  for (pbf::Double3& x : c.particles.position)
    for (std::size_t a = 0; a < 3; ++a) x[a] = 2.5 * (x[a] - low[a]);
  c.scene.gravity = {0, 0, -10};
  c.scene.time = {0.02, 2, pbf::AdaptiveTime{}};
  c.scene.time.adaptive->cfl = c.scene.time.adaptive->force = 100;  // alarms alone
  c.scene.solver.iterations = 1;
  c.scene.solver.sor = 0.84;  // more than is stable at that step
  return c;
}

struct Course {
  std::vector<std::string> notes;
  pbf::Diagnostics last;
  double energy_start = 0, energy_most = 0, shortest = 1;
  bool stopped = false;
  std::int64_t repeats = 0;
};

/// A session under a Monitor, measured every `every` updates.
Course watched(const Case& c, pbf::Solver& solver, int updates, int every) {
  Course course;
  pbf::Scene scene = c.scene;
  scene.measure_every = every;
  scene.time.end = updates * scene.time.step;
  const pbf::Plan plan = pbf::make_plan(scene, std::int64_t(c.particles.size()));
  pbf::Monitor monitor(
      scene, plan, solver,
      [&](const pbf::Diagnostics& m, double dt) {
        if (m.update == 0) course.energy_start = pbf::total_energy(m);
        course.energy_most = std::max(course.energy_most, pbf::total_energy(m));
        course.shortest = std::min(course.shortest, dt);
      },
      [&](const std::string& line) { course.notes.push_back(line); });
  pbf::Session(solver, {&monitor, &monitor.choosing()}).run(updates);
  course.last = monitor.last();
  course.stopped = monitor.event() != nullptr;
  course.repeats = monitor.steps()->repeats;
  return course;
}

}  // namespace

TEST_CASE("an update at level k is 2^k updates of the scene with what goes with the shorter step") {
  const int level = GENERATE(0, 1, 3);
  CAPTURE(level);
  Case c = everything_adaptive();
  if (GENERATE(false, true)) c.scene.vorticity.reset();  // then XSPH also predicts
  auto coarse = make(c);
  const int steps = 1 << level;
  c.scene.time.step /= steps;
  c.scene.time.adaptive.reset();
  c.scene.solver.velocity_damping = std::pow(0.97, 1.0 / steps);
  c.scene.viscosity->xsph /= steps;
  c.scene.tensile->k /= steps * steps;
  auto fine = make(c);
  for (const int updates : {1, 2, 9}) {
    coarse->step(updates, {.level = level});
    fine->step(updates * steps);
    REQUIRE(same_particles(coarse->state(), fine->state()));
  }
  CHECK(coarse->updates() == 12);
  CHECK(coarse->state().steps == fine->state().steps);
  CHECK(coarse->diagnose().iterations_done == fine->diagnose().iterations_done);
}

TEST_CASE("levels that change in the middle: the bits of the pieces, in one solver or in several") {
  const Case c = everything_adaptive();
  auto one = make(c);
  pbf::SolverState state = one->state();
  for (const int level : {0, 2, 1, 0, 3, 0}) {
    one->step(3, {.level = level});
    auto other = make(c);
    other->set_state(state);
    other->step(3, {.level = level});
    state = other->state();
    REQUIRE(same_particles(one->state(), state));
    CHECK(one->state().steps == state.steps);
  }
  CHECK(state.updates == 18);
  CHECK(state.steps == 3 * (1 + 4 + 2 + 1 + 8 + 1));
}

TEST_CASE("updates with changing levels move every particle as the CPU in double does") {
  Case c = everything_adaptive();
  auto a = make(c);
  c.scene.backend = pbf::Backend::cpu;
  c.scene.precision = pbf::Precision::dbl;
  auto b = make(c);
  for (const int level : {1, 0, 2})
    for (auto* s : {a.get(), b.get()}) {
      s->step(2, {.level = level});
      s->step(3, {.without_time = 0.9});
    }
  const auto x = a->download({}, pbf::ScalarType::f64).get(),
             y = b->download({}, pbf::ScalarType::f64).get();
  const auto p = x.fields[0].as<double>(), q = y.fields[0].as<double>();
  double worst = 0;
  for (std::size_t k = 0; k < p.size(); ++k)
    worst = std::max(worst, std::fabs(p[k] - q[k]) / c.scene.h());
  CHECK(worst < (is_double() ? 1e-10 : 2e-3));
}

TEST_CASE("steps without time part the particles, and velocities take the damping alone") {
  Case c = here(jittered_block(8, 8, 8, 0.3, 0.4, 1, 0.9));
  c.scene.viscosity = pbf::Viscosity{0.3};
  c.scene.vorticity = pbf::Vorticity{5};
  auto s = make(c);
  const double before = s->diagnose().compression_mean;
  const auto v = s->download({"velocity"}, pbf::ScalarType::f64).get();
  s->step(24, {.without_time = 1.0});
  const pbf::Diagnostics m = s->diagnose();
  CHECK(before > 0.1);
  CHECK(m.compression_mean < 0.1 * before);
  CHECK(m.outside == 0);
  CHECK(m.iterations_done == 24 * c.scene.solver.iterations);
  CHECK(s->updates() == 0);
  const auto w = s->download({"velocity"}, pbf::ScalarType::f64).get();
  CHECK(w.find("velocity")->bytes == v.find("velocity")->bytes);
  CHECK(w.fields[0].bytes != v.fields[0].bytes);
  s->step(2, {.without_time = 0.5});
  const auto half = s->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto from = v.find("velocity")->as<double>(), to = half.find("velocity")->as<double>();
  for (std::size_t k = 0; k < from.size(); ++k) REQUIRE(to[k] == 0.25 * from[k]);
  // And updates go on as from the same state in a new solver.
  auto fresh = make(c);
  fresh->set_state(s->state());
  s->step(5);
  fresh->step(5);
  CHECK(same_particles(s->state(), fresh->state()));
}

TEST_CASE("an alarm takes the run back, and with a shorter step it comes to its end") {
  const Case c = unstable_pool();
  const pbf::Plan plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  auto fixed = make(c);
  const pbf::Diagnostics first = fixed->diagnose();
  pbf::Guard guard(c.scene, plan, *fixed, first, first);
  std::optional<pbf::GuardEvent> event;
  while (!event && fixed->updates() < 100) {
    fixed->step(5, guard.options());
    event = check(guard, fixed->diagnose());
  }
  REQUIRE(event);  // the guard stops it today

  auto solver = make(c);
  const Course course = watched(c, *solver, 100, 5);
  CHECK_FALSE(course.stopped);
  CHECK(solver->updates() == 100);
  CHECK(course.repeats >= 1);
  REQUIRE(!course.notes.empty());
  // Neighbors that move too far past each other may have halved the step before.
  const auto alarm = std::find_if(course.notes.begin(), course.notes.end(), [](const auto& note) {
    return note.find("alarm of the guard (energy), back to update ") != std::string::npos;
  });
  REQUIRE(alarm != course.notes.end());
  CHECK(alarm->find("steps without time") != std::string::npos);
  CHECK(course.shortest < 0.02);
  CHECK(course.energy_most < 1.1 * course.energy_start);
  CHECK(course.last.compression_mean < 0.1);
  CHECK(course.last.non_finite + course.last.outside == 0);
}

TEST_CASE("with the shortest step the guard stops the run, at the update of the event") {
  Case c = everything_adaptive();
  c.scene.time.order = pbf::TimeOrder::first;  // no neighbors halve the step before the event
  c.scene.time.adaptive->step_min = c.scene.time.step / 4;
  auto solver = make(c);
  solver->inspection()->inject({7, "delta", 2, 40, 1e6});
  const Course course = watched(c, *solver, 20, 5);
  CHECK(course.stopped);
  CHECK(course.repeats == 2);
  CHECK(solver->updates() == 7);
  CHECK(course.notes.size() == 2);
}

TEST_CASE("what is wrong at the start is not tried again with a shorter step") {
  Case c = everything_adaptive();
  c.scene.guard->speed = 1e-3;
  auto solver = make(c);
  const pbf::Plan plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  pbf::Monitor monitor(c.scene, plan, *solver, [](const pbf::Diagnostics&, double) {});
  pbf::Session(*solver, {&monitor}).run(10);
  CHECK(solver->updates() == 0);
  REQUIRE(monitor.event());
  CHECK(monitor.guard()->text(*monitor.event()).find("before the first update") !=
        std::string::npos);
}
