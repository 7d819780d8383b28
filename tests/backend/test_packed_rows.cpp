// Packed rows (lib/program/packed_rows.h), here for few particles too: their plans say so where
// the backend has such passes.
#include "lib/program/packed_rows.h"

#include <cmath>

#include "lib/exec/make_solver.h"
#include "tests/support/backend.h"
#include "tests/support/obstacle_shapes.h"
#include "tests/support/rank_runs.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;

namespace {

void set_packed(const pbf::Scene& scene, pbf::Plan& plan, bool packed) {
  plan.turns = false;
  plan.packed = packed && pbf::is_fast_on_gpu(scene);
  plan.program = pbf::make_program(scene, plan.shape());
}
std::unique_ptr<pbf::Solver> solver_of(const Case& c, bool packed) {
  pbf::Plan plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  set_packed(c.scene, plan, packed);
  return pbf::make_solver(c.scene, plan, c.particles);
}
/// Root of the mean square of the differences of all coordinates, in h, after some updates.
double difference_after(pbf::Solver& a, pbf::Solver& b, int updates) {
  a.step(updates), b.step(updates);
  const pbf::SolverState x = a.state(), y = b.state();
  REQUIRE(x.id == y.id);
  double sum = 0;
  for (std::size_t k = 0; k < x.position.size(); ++k)
    sum += (x.position[k] - y.position[k]) * (x.position[k] - y.position[k]);
  return std::sqrt(sum / double(x.position.size()));
}

}  // namespace

TEST_CASE("packed rows move particles as the CPU in double does, nearly as well as plain rows") {
  Case c = here(jittered_block(16, 15, 17, 0.3, 0.4));
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.viscosity->xsph = 0.1;
  const int updates = GENERATE(1, 10);
  Case exact = c;
  exact.scene.backend = pbf::Backend::cpu;
  exact.scene.precision = pbf::Precision::dbl;
  const auto off = [&](bool packed) {
    const auto a = solver_of(c, packed), b = solver_of(exact, false);
    return difference_after(*a, *b, updates);
  };
  const double plain = off(false), packed = off(true);
  CAPTURE(updates, plain, packed);
  // Differences grow in each update.
  CHECK(packed < (is_double() ? plain : updates == 1 ? 1.5 * plain + 1e-6 : 5 * plain) + 1e-12);
  CHECK(packed < (is_double() ? 1e-12 : updates == 1 ? 2e-6 : 2e-5));
  if (pbf::is_fast_on_gpu(c.scene)) CHECK(packed != plain);
}

TEST_CASE("packed rows: hyperviscosity takes what it takes of the CPU in double, and no momentum") {
  // Small and large differences, of which it leaves more.
  const Case c = here(jittered_block(12, 11, 13, GENERATE(0.0, 0.3), 0.01));
  const auto velocities = [&](bool exact, double rate) {
    Case of = c;
    of.scene.solver.hyperviscosity = rate;
    if (exact) of.scene.backend = pbf::Backend::cpu, of.scene.precision = pbf::Precision::dbl;
    const auto solver = solver_of(of, !exact);
    solver->step(2);  // it acts behind the second
    return solver->state().velocity;
  };
  const auto taken = [&](bool exact) {
    std::vector<double> v = velocities(exact, 10);
    const std::vector<double> without = velocities(exact, 0);
    for (std::size_t k = 0; k < v.size(); ++k) v[k] -= without[k];
    return v;
  };
  const std::vector<double> of_double = taken(true), packed = taken(false);
  double squares = 0, off = 0, sum[3] = {};
  for (std::size_t k = 0; k < packed.size(); ++k) {
    squares += of_double[k] * of_double[k];
    off += (packed[k] - of_double[k]) * (packed[k] - of_double[k]);
    sum[k % 3] += packed[k];
  }
  const double particles = double(packed.size() / 3), effect = std::sqrt(squares / particles);
  CAPTURE(effect, off, sum[0], sum[1], sum[2]);
  CHECK(effect > 1e-3);
  CHECK(std::sqrt(off / particles) < (is_double() ? 1e-9 : 5e-3) * effect);
  for (const double of_axis : sum) CHECK(std::abs(of_axis) / particles < 1e-4 * effect);
}

TEST_CASE("packed rows: updates give the bits of passes one by one") {
  Case c = backend_test::falling_block(13);
  SECTION("second order") {}
  SECTION("first order") { c.scene.time.order = pbf::TimeOrder::first; }
  SECTION("substeps, which share lists") { c.scene.solver.substeps = 3; }
  SECTION("substeps in first order") {
    c.scene.time.order = pbf::TimeOrder::first;
    c.scene.solver.substeps = 4;
  }
  SECTION("more iterations while it is compressed") {
    c.scene.solver.tolerance = 1e-4;
    c.scene.solver.max_iterations = 24;
  }
  SECTION("an obstacle") {
    const double h = c.scene.h();
    c.scene.obstacles = {pbf_test::box_obstacle({2 * h, 2 * h, 0}, {4 * h, 4 * h, 2 * h})};
    c.scene.obstacles[0].loads = true;
  }
  SECTION("walls with loads") { c.scene.domain.loads = true; }
  SECTION("levels") { c.scene.solver.levels = pbf::LevelsMode::on; }
  SECTION("no viscosity") { c.scene.viscosity.reset(); }
  SECTION("friction between XSPH and the next update") { c.scene.domain.friction = 0.5; }
  SECTION("vorticity") { c.scene.vorticity = pbf::Vorticity{}; }
  SECTION("hyperviscosity behind every eighth update") { c.scene.solver.hyperviscosity = 4; }
  SECTION("a tank that moves") {
    c.scene.tank_motion = pbf::TankMotion{};
    c.scene.tank_motion->axis = pbf::Double3{0, 1, 0};
    c.scene.tank_motion->amplitude = 12;
    c.scene.tank_motion->period = 0.4;
  }
  const auto ending = [&](bool one_by_one) {
    return backend_test::ending_of(*solver_of(c, true), one_by_one, 12);
  };
  backend_test::check_same(ending(false), ending(true));
}

TEST_CASE("packed rows: ranks that share a device give the bits of one") {
  using namespace pbf::test;
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"viscosity.xsph=0.1"},
           {"viscosity.xsph=0.1", "vorticity.epsilon=1", "tensile={}", "time.order=1"},
           {"solver.substeps=3"},
           {"viscosity.xsph=0.1", "domain.loads=true"}}) {
    std::vector<std::string> set{"fluid.spacing=0.04"};
    set.push_back(std::string("backend=") + word(backend_test::backend()));
    set.push_back(std::string("precision=") + word(backend_test::precision()));
    set.insert(set.end(), more.begin(), more.end());
    RankScene m("configs/minimal", set);
    set_packed(m.scene, m.plan, true);
    const std::vector<Seen> one = on_one(m, 40), two = on_ranks(m, 2, 40);
    for (std::size_t k = 0; k < one.size(); ++k) {
      CAPTURE(set, k);
      check_same(one[k], two[k], m.scene);
    }
  }
}

TEST_CASE("packed rows: a particle at the corners of large boxes finds its neighbors") {
  // Rows hold positions modulo 4 h.
  Case c = here(jittered_block(10, 10, 10, 0.3, 0.3));
  const double h = c.scene.h(), far = GENERATE(0, 3, 1000);
  for (int k = 0; k < 3; ++k) c.scene.domain.max[std::size_t(k)] += far * h;
  for (auto& x : c.particles.position)
    for (int k = 0; k < 3; ++k) x[std::size_t(k)] += far * h;
  const auto packed = solver_of(c, true), plain = solver_of(c, false);
  CAPTURE(far);
  CHECK(difference_after(*packed, *plain, 1) < 1e-6 * std::max(far, 2.0));
  CHECK(packed->diagnose().compression_mean ==
        Approx(plain->diagnose().compression_mean).epsilon(1e-3));
}
