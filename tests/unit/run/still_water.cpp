// Still water stays still with few iterations in a substep: the default of solver.sor, its limit,
// and what is told beyond it.
#include <algorithm>
#include <cmath>

#include "lib/exec/make_solver.h"
#include "lib/program/relaxation.h"
#include "lib/run/emit.h"
#include "lib/scene/load.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"
#include "tests/support/warning_text.h"

using namespace pbf;

namespace {

/// A pool of 60 x 20 spacings of 10 mm that rests in a tank.
Scene pool(std::vector<std::string> set) {
  return scene_test::parse(
      "dimensions: 2\n"
      "domain: {min: [0, 0], max: [0.6, 0.4]}\n"
      "fluid: {spacing: 0.01}\n"
      "bodies: [{shape: block, min: [0, 0], max: [0.6, 0.2]}]\n"
      "threads: 1\n"
      "time: {step: auto, end: 0.3}\n",
      std::move(set));
}

/// m/s, the largest speed until time.end.
double fastest(const Scene& s) {
  Particles particles = emit_particles(s, ".");
  const Plan plan = make_plan(s, std::int64_t(particles.size()));
  const auto solver = make_solver(s, plan, std::move(particles));
  double speed = 0;
  for (double t = 0; t < s.time.end; t += 4 * s.time.step) {
    solver->step(4);
    speed = std::max(speed, solver->diagnose().speed_max);
  }
  return speed;
}

}  // namespace

TEST_CASE("still water does not burst with one iteration in a substep, however large h is") {
  for (const char* ratio : {"1.6", "2", "2.5", "3", "3.5"})
    for (const char* set : {"solver.substeps=4", "solver.substeps=8", "solver.levels=on"}) {
      const Scene s = pool(
          {std::string("fluid.smoothing_ratio=") + ratio, "solver.iterations=1", std::string(set)});
      CAPTURE(ratio, set, default_sor(s));
      CHECK(fastest(s) < 2.5 * std::sqrt(9.81 * s.fluid.spacing));
      CHECK(text_of("relaxation", s).empty());
    }
}

TEST_CASE("a step length with which still water bursts is named with the one that is safe") {
  const Scene wild = pool({"solver.iterations=1", "solver.substeps=4", "solver.sor=1"});
  CHECK(text_of("relaxation", wild) ==
        "solver.sor 1 is above 0.783, up to which still water stays still with 1 iteration in a "
        "substep and h = 2 spacings: the fluid may gain energy and burst; leave it out (0.712), or "
        "give 4 iterations");
  CHECK(text_of("relaxation", pool({"solver.iterations=1", "solver.sor=0.78"})).empty());
  CHECK(text_of("relaxation", pool({"solver.iterations=4", "solver.sor=1.2"})).empty());
  CHECK_FALSE(text_of("relaxation", pool({"solver.iterations=4", "solver.sor=1.3"})).empty());
  CHECK(text_of("relaxation", pool({"solver.iterations=0", "solver.sor=1.9"})).empty());
  // What is named does burst.
  CHECK(fastest(pool({"solver.iterations=1", "solver.substeps=4", "solver.sor=1",
                      "fluid.smoothing_ratio=2.5"})) > 3);
}

TEST_CASE("the default step length falls with the neighbors, and with few iterations") {
  for (const char* dimensions : {"2", "3"}) {
    Scene s;
    s.dimensions = dimensions[0] - '0';
    double before = 2;
    for (const double ratio : {1.6, 2.0, 2.5, 3.0, 3.5, 5.0}) {
      s.fluid.smoothing_ratio = ratio;
      double fewer = 0;
      for (const int iterations : {1, 2, 3, 4, 16}) {
        s.solver.iterations = iterations;
        CHECK(default_sor(s) >= fewer);
        fewer = default_sor(s);
        CHECK(sor_limit(s) > default_sor(s));
      }
      s.solver.iterations = 1;
      CHECK(default_sor(s) <= before);
      before = default_sor(s);
    }
  }
}
