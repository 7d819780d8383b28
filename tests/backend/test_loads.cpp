// Loads on the walls (domain.loads) against what the particles' momentum says, on every backend
// and precision.

#include <array>
#include <cmath>
#include <map>

#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::loads_of;
using backend_test::Series;
using backend_test::WallLoad;

namespace {

constexpr double kStep = 0.004;

/// A block that falls into a corner of a box and splashes.
Case splash() {
  Case c = jittered_block(9, 6, 12, 0.1, 0.3, 1, 1);
  c.scene.domain.max = {c.scene.domain.min[0] + 0.27, c.scene.domain.min[1] + 0.15,
                        c.scene.domain.min[2] + 0.4};
  c.scene.gravity = {1.7, -0.6, -9.81};
  c.scene.time.step = kStep;
  c.scene.domain.loads = true;
  return here(c);
}
Case flat_splash() {
  Case c = flat_block(14, 30, 0.1, 0.3, 1, 1);
  c.scene.domain.max[0] = c.scene.domain.min[0] + 0.44;
  c.scene.gravity = {1.1, 0, -9.81};
  c.scene.time.step = kStep;
  c.scene.domain.loads = true;
  return here(c);
}

struct Balance {
  double error = 0;  ///< largest component of (sum of loads) - (M g - dP/dt), over M g
  double load = 0;   ///< N, of the floor, mean
};
Balance balance(const Case& c, int updates) {
  auto solver = make(c);
  if (c.scene.time.order == pbf::TimeOrder::second) {
    solver->step(1);  // from here on velocities are those of half a step earlier
    loads_of(c, *solver, pbf::Interval::ends);
  }
  const pbf::Plan plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  const double mass = plan.mass * double(plan.particles), time = updates * c.scene.time.step;
  const pbf::Diagnostics before = solver->diagnose();
  solver->step(updates, {});
  const pbf::Diagnostics after = solver->diagnose();
  Balance b;
  double sum[3] = {0, 0, 0}, weight = 0;
  for (const WallLoad& l : loads_of(c, *solver)) {
    for (int k = 0; k < 3; ++k) sum[k] += l.force[k];
    if (l.wall == "z_min") b.load = -l.force[2];
  }
  for (const double g : c.scene.gravity) weight += mass * mass * g * g;
  for (std::size_t k = 0; k < 3; ++k) {
    const double expected =
        mass * c.scene.gravity[k] - (after.momentum[k] - before.momentum[k]) / time;
    b.error = std::max(b.error, std::fabs(sum[k] - expected) / std::sqrt(weight));
  }
  return b;
}

void check_balance(const Case& c, int updates = 100) {
  const Balance b = balance(c, updates);
  CHECK(b.load > 0.01);  // the fluid has reached the floor
  // In float every velocity is rounded, by up to 2^-24 of it, in every iteration.
  CHECK(b.error < (is_double() ? 1e-9 : 2e-4));
}

}  // namespace

TEST_CASE("the loads on the walls are the weight less the change of momentum") {
  Case c = GENERATE(false, true) ? flat_splash() : splash();
  c.scene.time.order = GENERATE(pbf::TimeOrder::first, pbf::TimeOrder::second);
  CAPTURE(int(c.scene.time.order));
  SECTION("defaults") {}
  SECTION("one iteration, Chebyshev's steps") {
    c.scene.solver.iterations = 3;
    c.scene.solver.method = pbf::SolverMethod::chebyshev;
  }
  SECTION("walls that only clamp, at a distance") {
    c.scene.solver.boundary = pbf::BoundaryMode::clamp;
    c.scene.solver.wall_margin = 0.006;
  }
  SECTION("substeps") {
    c.scene.solver.substeps = 3;
    c.scene.solver.iterations = 1;
  }
  SECTION("the paper's kernels, tensile, viscosity") {
    c.scene.solver.kernels = pbf::KernelMode::paper;
    c.scene.tensile = pbf::Tensile{0.002, 0.3, 4};
    c.scene.viscosity = pbf::Viscosity{0.1};
  }
  SECTION("a tolerance") { c.scene.solver.tolerance = 0.001; }
  SECTION("no iterations: particles that only hit walls") { c.scene.solver.iterations = 0; }
  SECTION("levels") {
    c.scene.solver.levels = pbf::LevelsMode::on;
    c.scene.solver.iterations = 2;
  }
  check_balance(c);
}

TEST_CASE("the walls of a tank at rest bear what hydrostatics says, whatever the axes", "[slow]") {
  const std::size_t up = std::size_t(GENERATE(0, 1, 2));
  const bool upside_down = GENERATE(false, true);
  const pbf::Double3 size{0.24, 0.2, 0.28};
  const double d = 0.02, depth = 6 * d, g = 9.81, rho = 1000;
  Case c;
  c.scene.fluid.spacing = d;
  c.scene.domain = {{-3, 5, 0.5}, {}, {}, true};
  pbf::Double3 count;
  for (std::size_t k = 0; k < 3; ++k) {
    c.scene.domain.max[k] = c.scene.domain.min[k] + size[k];
    count[k] = std::round((k == up ? depth : size[k]) / d);
  }
  for (double z = 0; z < count[2]; ++z)
    for (double y = 0; y < count[1]; ++y)
      for (double x = 0; x < count[0]; ++x) {
        pbf::Double3 at{(x + 0.5) * d, (y + 0.5) * d, (z + 0.5) * d};
        if (upside_down) at[up] = size[up] - at[up];
        for (std::size_t k = 0; k < 3; ++k) at[k] += c.scene.domain.min[k];
        c.particles.position.push_back(at);
        c.particles.velocity.push_back({});
      }
  c.scene.gravity = {};
  c.scene.gravity[up] = upside_down ? g : -g;
  c.scene.time.step = 0.002;
  c = here(c);
  auto solver = make(c);
  solver->step(150, {});
  solver->readings(Series::measures, pbf::Interval::ends);
  solver->step(350, {});
  const auto loads = loads_of(c, *solver, pbf::Interval::ends);
  REQUIRE(loads.size() == 6);
  const double weight = rho * g * depth * size[(up + 1) % 3] * size[(up + 2) % 3];
  for (std::size_t wall = 0; wall < 6; ++wall) {
    CAPTURE(up, upside_down, loads[wall].wall);
    const std::size_t axis = wall / 2, other = 3 - axis - up;
    const bool high = wall % 2 == 1;
    double force[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
    if (axis != up) {
      force[axis] = (high ? 1 : -1) * rho * g * depth * depth / 2 * size[other];
      // The force acts at a third of the depth, seen from the middle of the wall.
      const double arm = (upside_down ? 1 : -1) * (size[up] / 2 - depth / 3);
      // e_up x e_axis = +-e_other
      const double sign = (axis + 3 - up) % 3 == 1 ? 1 : -1;
      torque[other] = sign * arm * force[axis];
    } else if (high == upside_down) {
      force[axis] = (high ? 1 : -1) * weight;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(loads[wall].force[k] == Approx(force[k]).margin(0.015 * weight));
      CHECK(loads[wall].torque[k] == Approx(torque[k]).margin(0.002 * weight));
    }
    CHECK(loads[wall].peak >= 0.99 * std::fabs(force[axis]));
  }
  // Nothing has happened since.
  for (const WallLoad& l : loads_of(c, *solver)) CHECK(l.peak == 0);
}

TEST_CASE("loads do not depend on threads, pass-by-pass updates, or being handed over") {
  Case c = splash();
  c.scene.solver.substeps = 2;
  auto a = make(c);
  a->step(40, {});
  const auto expected = a->readings(Series::measures, pbf::Interval::goes_on);
  SECTION("threads") {
    c.scene.threads = 1;
    auto b = make(c);
    b->step(40, {});
    backend_test::check_loads(*b, expected);
  }
  SECTION("pass by pass") {
    auto b = make(c);
    b->step(20, {});
    for (int k = 0; k < 20; ++k) b->inspection()->trace();
    backend_test::check_loads(*b, expected);
  }
  SECTION("handed over in the middle") {
    auto first = make(c), second = make(c);
    first->step(25, {});
    second->set_state(first->state());
    second->step(15, {});
    backend_test::check_loads(*second, expected);
  }
  SECTION("back to a kept state, and steps without time") {
    auto b = make(c);
    b->step(10, {});
    b->keep();
    b->step(7, {});
    b->set_state(b->state(pbf::StateOf::kept));
    const pbf::SolverState there = b->state();
    b->step(5, {.without_time = 1.0});
    pbf::SolverState back = b->state();
    CHECK(*back.find("loads") == *there.find("loads"));
    b->set_state(there);
    b->step(30, {});
    backend_test::check_loads(*b, expected);
  }
}

TEST_CASE(
    "the impulse of a load since the start is that of its means, however often they are read") {
  const Case c = GENERATE(false, true) ? splash() : flat_splash();
  std::vector<WallLoad> last;
  for (const int every : {1, 4, 40}) {
    auto solver = make(c);
    std::map<std::string, std::array<double, 3>> sum;
    for (int u = 0; u < 40; u += every) {
      solver->step(every);
      // A reading between two that end an interval changes nothing.
      if (u == 20) loads_of(c, *solver, pbf::Interval::goes_on);
      for (const WallLoad& l : loads_of(c, *solver, pbf::Interval::ends))
        for (std::size_t k = 0; k < 3; ++k) sum[l.wall][k] += l.force[k] * every * kStep;
    }
    const std::vector<WallLoad> end = loads_of(c, *solver);
    for (std::size_t w = 0; w < end.size(); ++w)
      for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(every, end[w].wall, k);
        CHECK(end[w].impulse[k] == Approx(sum[end[w].wall][k]).margin(1e-9));
        if (!last.empty()) CHECK(end[w].impulse[k] == last[w].impulse[k]);
      }
    last = end;
    CHECK(std::fabs(sum["z_min"][2]) > 0.01);
  }
}
