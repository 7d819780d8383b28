// What the guard allows a run's energy, and what it advises.
#include <algorithm>
#include <cmath>
#include <random>

#include "lib/campaign/stability.h"
#include "lib/exec/make_solver.h"
#include "lib/program/program.h"
#include "lib/run/emit.h"
#include "lib/run/start.h"
#include "tests/support/catch.h"
#include "tests/support/guard_check.h"
#include "tests/support/scene_samples.h"

namespace pbf::scene_test {
namespace {

/// A guard over a solver of the scene as it is given.
struct Watched {
  Scene scene;
  Plan plan;
  std::unique_ptr<Solver> solver;
  Diagnostics first;
  explicit Watched(const Scene& s)
      : scene(s),
        plan(make_plan(s, count_particles(s, "."))),
        solver(make_solver(s, plan, emit_particles(s, "."))),
        first(solver->diagnose()) {}
  Guard guard(const Diagnostics& start) { return Guard(scene, plan, *solver, start, start); }
  double mass() const { return plan.mass * double(plan.particles); }
};

/// The measure seen from a frame that moves by -v along x.
Diagnostics moving(Diagnostics m, double mass, double v) {
  m.kinetic_energy += m.momentum[0] * v + 0.5 * mass * v * v;
  m.momentum[0] += mass * v;
  return m;
}

/// What a guard says to a fault of that kind in a stage.
std::string advice(const Scene& s, const Diagnostics* start, Alarm alarm,
                   const std::string& stage) {
  Watched w(s);
  const Guard guard = w.guard(start ? *start : w.first);
  GuardEvent e;
  e.alarm = alarm;
  e.measure = w.first;
  e.stage = StageEvent{alarm, 3, stage, "", 0, 5, {}, {}, 1};
  const auto passes = pass_texts();
  const auto of_stage = [&](const PassText& pass) { return pass.stage == stage; };
  e.stage->remedy = std::find_if(passes.begin(), passes.end(), of_stage)->remedy;
  const std::string text = guard.text(e);
  return text.substr(text.find("To help: "));
}

}  // namespace

TEST_CASE("guard: energy that a start cannot release ends the run") {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
  };
  for (const Case& c :
       {Case{"tank_at_rest",
             {"fluid.spacing=0.04", "time.end=0.2", "solver.constraint=two_sided",
              "tensile.k=0.01"}},
        Case{"stiff/overfull", {"bodies[0].count=3000", "time.end=0.4"}},
        Case{"minimal", {"fluid.spacing=0.04", "fluid.mass=0.64", "time.end=0.2"}},
        Case{"tank_at_rest", {"fluid.spacing=0.04", "fluid.mass=0.64", "time.end=0.4"}}})
    for (const char* relieved : {"true", "false"}) {
      std::vector<std::string> set = c.set;
      set.push_back(std::string("solver.prestabilize=") + relieved);
      CAPTURE(c.scene, set);
      const Course course = run_course(prepare(shipped(c.scene, set), ".")).value();
      REQUIRE(course.event);
      CHECK((course.event->alarm == Alarm::energy || course.event->alarm == Alarm::speed));
    }
}

TEST_CASE("guard: a jittered ball without gravity runs to its end, however fast it flies") {
  const Folder folder;
  std::mt19937 gen(7);
  // Half as far off its places, the ball's mean compression is below the 1 % that a guard
  // overlooks.
  for (const double jitter : {0.1, 0.2}) {
    folder.write("ball.csv", scene_test::jittered_ball(jitter, gen));
    for (const double speed : {0.0, 1.0, 20.0})
      for (const char* step : {"0.004", "0.0005"}) {
        CAPTURE(jitter, speed, step);
        Scene s = shipped("extreme/drop", {std::string("time.step=") + step, "time.end=0.2"});
        s.bodies[0].shape = Shape::file;
        s.bodies[0].path = "ball.csv";
        s.bodies[0].velocity = {speed, 0, 0};
        const Course c = run_course(prepare(s, folder.path.string())).value();
        CHECK_FALSE(c.event);
        CHECK(c.guard_text.empty());
      }
  }
}

TEST_CASE("guard: the energy that a run may gain is the same for every observer") {
  for (const char* gravity : {"gravity=[0, 0, 0]", "gravity=[0, 0, -10]"}) {
    Watched w(shipped("extreme/drop", {gravity}));
    Diagnostics first = w.first;
    first.kinetic_energy += 3;  // of an inner motion
    Diagnostics later = first;
    later.update = 50;
    later.kinetic_energy += 40;
    const double seen = w.guard(first).energy_limit(later) - total_energy(first);
    CHECK(seen > 0);
    for (const double v : {-0.5, 1.0, 20.0, 1e3}) {
      CAPTURE(gravity, v);
      const Diagnostics a = moving(first, w.mass(), v), b = moving(later, w.mass(), v);
      CHECK(w.guard(a).energy_limit(b) - total_energy(a) == Approx(seen).epsilon(1e-6));
    }
  }
}

TEST_CASE(
    "guard: a compressed start may release energy until it has come apart, and no start for "
    "ever") {
  Watched w(shipped("stiff/overfull"));
  Diagnostics start = w.first;
  start.compression_mean = 0.5;
  const double first = total_energy(start), bare = w.guard(start).limits().energy;
  Diagnostics m = start;
  m.update = 5;
  Guard guard = w.guard(start);
  const double while_apart = guard.energy_limit(m);
  const double h_per_step = w.scene.h() / w.scene.time.step;
  CHECK(while_apart == Approx(bare + 0.49 * 0.5 * w.mass() * h_per_step * h_per_step));
  SECTION("apart: what it has by then, and the usual share") {
    m.compression_mean = 0.005;
    m.kinetic_energy = 100;
    CHECK_FALSE(check(guard, m));
    Diagnostics next = m;
    next.compression_mean = 0.3;  // pressed together again: that releases nothing
    next.update = 10;
    CHECK(guard.energy_limit(next) < first + 100 + 0.2 * (first + 100));
    CHECK(guard.energy_limit(next) > first + 100);
    CHECK(guard.released() == Approx(first + 100));
  }
  SECTION("never apart: what it began with") {
    m.update = release_updates(w.scene) + 1;
    CHECK(guard.energy_limit(m) == Approx(bare));
    m.kinetic_energy = 0.5 * (while_apart - first);
    CHECK(guard.alarm(m) == Alarm::energy);
  }
  SECTION("two-sided: its surface, for the same time") {
    Watched two(shipped("stiff/pool", {"solver.constraint=two_sided"}));
    Guard other = two.guard(two.first);
    Diagnostics late = two.first;
    const double soon = other.energy_limit(late);
    CHECK(soon > other.limits().energy);
    late.update = release_updates(two.scene) + 1;
    REQUIRE_FALSE(check(other, late));
    CHECK(other.energy_limit(late) == Approx(other.limits().energy));
  }
}

TEST_CASE("guard: with gravity, a shorter step does not widen what the energy may gain") {
  const auto allowed = [](const char* step) {
    Watched w(shipped("tank_at_rest", {"fluid.spacing=0.04", std::string("time.step=") + step,
                                       "precision=double"}));
    Start start = prepare(w.scene, ".");
    const Diagnostics apart = solver_of(start)->diagnose();
    return w.guard(apart).energy_limit(apart) - total_energy(apart);
  };
  CHECK(allowed("1e-6") == Approx(allowed("1e-4")).epsilon(0.01));
}

TEST_CASE("guard: the advice fits the cause") {
  const Scene plain = shipped("stiff/pool");
  const std::string usual = advice(plain, nullptr, Alarm::energy, "delta");
  CHECK(contains(usual, "lower time.step"));
  CHECK_FALSE(contains(usual, "prestabilize"));
  CHECK(advice(shipped("stiff/pool", {"viscosity.xsph=4"}), nullptr, Alarm::energy, "xsph") ==
        "To help: lower viscosity.xsph");
  CHECK(advice(shipped("stiff/pool", {"vorticity.epsilon=9"}), nullptr, Alarm::speed,
               "vorticity") == "To help: lower vorticity.epsilon");
  const std::string tensile =
      advice(shipped("stiff/pool", {"tensile.k=9", "solver.constraint=two_sided"}), nullptr,
             Alarm::energy, "delta");
  CHECK(contains(tensile, "lower tensile.k"));
  CHECK(contains(tensile, "solver.constraint: one_sided"));
  Diagnostics squeezed;
  squeezed.compression_mean = 0.46;
  const std::string full = advice(plain, &squeezed, Alarm::energy, "delta");
  CHECK(contains(full, "compressed by 46 % (mean); spread the bodies, or give them room"));
  CHECK(contains(full, "A shorter time.step makes it worse"));
  CHECK_FALSE(contains(full, "lower time.step"));
  CHECK_FALSE(contains(full, "fluid.mass"));
  const Scene heavy = shipped("stiff/pool", {"fluid.mass=1.25", "solver.prestabilize=false"});
  const std::string mass = advice(heavy, &squeezed, Alarm::speed, "delta");
  CHECK(contains(mass, "leave solver.prestabilize on"));
  CHECK(contains(mass, "check fluid.mass"));
}

}  // namespace pbf::scene_test
