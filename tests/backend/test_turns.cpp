// The CUDA backend makes lists and runs all iterations and XSPH in one launch where there are few
// particles (lib/program/turns.h). The bits are those of the passes one by one, which traces
// launch.
#include <thread>

#include "lib/scene/viscosity.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::check_same;
using backend_test::Ending;
using backend_test::ending_of;
using backend_test::falling_block;
using backend_test::here;
using backend_test::is_double;

namespace {

bool takes_turns(const Case& c) {
  return pbf::make_plan(c.scene, std::int64_t(c.particles.size())).turns;
}

/// One solver at a time: where several share a device, they do not take turns.
Ending after_updates(const Case& c, bool one_by_one, int updates = 12) {
  return ending_of(*make(c), one_by_one, updates);
}

}  // namespace

TEST_CASE("updates give the bits of passes one by one for all numbers of threads per particle") {
  const Case c = falling_block(GENERATE(5, 10, 14, 20, 25, 28, 33, 36, 47));
  CAPTURE(c.particles.size());
  const bool on_gpu = backend_test::backend() == pbf::Backend::cuda && !is_double();
  CHECK(takes_turns(c) == (on_gpu && c.particles.size() <= 24000));
  const int updates = c.particles.size() > 30000 ? 4 : 12;
  const Ending together = after_updates(c, false, updates);
  check_same(together, after_updates(c, true, updates));
  // One for lists, 8 passes and XSPH with the bins, at most 4 for the sort; at first a prediction.
  if (takes_turns(c)) CHECK(together.launches <= 5.5);
}

TEST_CASE("updates give the bits of passes one by one for all forms of these passes") {
  Case c = falling_block(12);
  c.scene.time.order = GENERATE(pbf::TimeOrder::first, pbf::TimeOrder::second);
  c.scene.solver.iterations = GENERATE(1, 2, 5);
  c.scene.tensile->n = GENERATE(3, 4);
  if (GENERATE(false, true)) c.scene.tensile.reset();
  check_same(after_updates(c, false), after_updates(c, true));
}

TEST_CASE("updates give the bits of passes one by one with what turns exclude or divide") {
  Case c = falling_block(13);
  SECTION("factors of each iteration") { c.scene.solver.method = pbf::SolverMethod::chebyshev; }
  SECTION("substeps") { c.scene.solver.substeps = 3; }
  SECTION("more iterations while it is compressed") {
    c.scene.solver.tolerance = 1e-4;
    c.scene.solver.max_iterations = 24;
  }
  SECTION("density and lambda apart") { c.scene.solver.fused = false; }
  SECTION("many iterations") { c.scene.solver.iterations = 33; }
  SECTION("walls with loads") { c.scene.domain.loads = true; }
  SECTION("no viscosity") { c.scene.viscosity.reset(); }
  SECTION("several sweeps of viscosity") {
    c.scene.viscosity->xsph = 0;
    c.scene.viscosity->kinematic = 1e-6;
    while (pbf::viscous_sweeps(c.scene).sweeps < 3) *c.scene.viscosity->kinematic *= 1.1;
  }
  SECTION("friction between XSPH and the next update") { c.scene.domain.friction = 0.5; }
  SECTION("hyperviscosity behind every eighth update") { c.scene.solver.hyperviscosity = 4; }
  SECTION("a tank that moves") {
    c.scene.tank_motion = pbf::TankMotion{};
    c.scene.tank_motion->axis = pbf::Double3{0, 1, 0};
    c.scene.tank_motion->amplitude = 12;
    c.scene.tank_motion->period = 0.4;
  }
  check_same(after_updates(c, false), after_updates(c, true));
}

TEST_CASE(
    "updates give the bits of passes one by one where lists are long and outgrow their room") {
  Case c = here(jittered_block(16, 16, 16, 0.3, 0.2, 1, GENERATE(0.5, 0.6, 0.75)));
  c.scene.solver.prestabilize = false;
  const Ending together = after_updates(c, false);
  CHECK(together.neighbors > 40);
  check_same(together, after_updates(c, true));
}

TEST_CASE("solvers of several sizes beside each other, on threads of their own, change no bit") {
  const Case small = falling_block(8), large = falling_block(24);
  const Ending a = after_updates(small, false, 300), b = after_updates(large, false, 300);
  Ending c, d;
  {
    const std::jthread one([&] { c = after_updates(small, false, 300); });
    const std::jthread other([&] { d = after_updates(large, false, 300); });
  }
  check_same(a, c);
  check_same(b, d);
}
