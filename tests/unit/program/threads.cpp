// The rule for the number of threads.
#include "lib/program/threads.h"
#include "lib/run/emit.h"

#include "lib/base/machine.h"
#include "lib/exec/make_solver.h"
#include "lib/program/plan.h"
#include "lib/solver/solver.h"
#include "tests/support/catch.h"
#include "tests/support/scene_samples.h"

using namespace pbf;

TEST_CASE("threads: what the scene gives wins, else one below 4096 particles, one per 1024 above") {
  Scene s;
  const int usable = usable_threads();
  for (const std::int64_t n : {1, 1000, 4095, 4096, 1 << 20, 2000000000}) {
    CAPTURE(n);
    s.threads = 0;
    const int chosen = solver_threads(s, n);
    CHECK(chosen >= 1);
    CHECK(chosen <= usable);
    if (n < 4096) CHECK(chosen == 1);
    if (n >= 4096) CHECK(chosen == std::min<std::int64_t>(usable, n / 1024));
    for (const int given : {1, 2, 64, 4096}) {
      s.threads = given;
      CHECK(solver_threads(s, n) == given);
    }
  }
}

TEST_CASE("a solver runs on the threads that the rule gives") {
  const Scene s = scene_test::parse(
      "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
      "fluid: {spacing: 0.1}\n"
      "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.4, 0.4]}]\n"
      "time: {step: 0.001, end: 1}\n",
      {});
  const Plan plan = make_plan(s, count_particles(s, "."));
  const auto solver = make_solver(s, plan, emit_particles(s, "."));
  CHECK(solver->info().threads == 1);
}
