// Obstacles over many updates: loads balance the momentum, buoyancy, and nothing gets through or
// in, on every backend and precision.
#include "tests/support/catch.h"
#include "tests/support/obstacles.h"

using namespace oracle_test;
using namespace obstacle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::loads_of;
using backend_test::Series;
using backend_test::WallLoad;
using pbf_test::ObstacleShape;

namespace {

Case splash(bool flat) {
  Case c = flat ? flat_block(14, 30, 0.1, 0.3) : jittered_block(9, 6, 14, 0.1, 0.3);
  pbf::Scene& s = c.scene;
  s.domain.max[0] = s.domain.min[0] + (flat ? 0.44 : 0.27);
  if (!flat) s.domain.max[1] = s.domain.min[1] + 0.15;
  s.domain.max[2] = s.domain.min[2] + 0.6;
  s.gravity = {1.1, flat ? 0 : -0.6, -9.81};
  s.time.step = 0.004;
  s.domain.loads = true;
  Placing put(s);
  for (auto& x : c.particles.position) x[2] += 0.12;  // falls onto them
  put.box({0.5, 0.4, 0.4}, {2, 1.9, 1.6}, {flat ? 0.0 : 1.0, 2, 0}, 25);
  put.sphere({4, 2, 1.7}, 1.1);
  pbf::obstacle_keys::Tube& capsule =
      pbf_test::tube_of(put.tube(ObstacleShape::capsule, {5.5, 1, 5}, {5.9, 3, 5.2}, 1));
  capsule.to[1] = flat ? capsule.from[1] : s.domain.min[1] + 0.12;
  return without_inner(here(c), 0.2);
}

/// h, along every axis; what a block of particles at so many h per step has for a velocity.
pbf::Double3 per_step(const pbf::Scene& s, pbf::Double3 way) {
  for (double& w : way) w *= s.h() / s.time.step;
  return way;
}

/// A box of so many h with the block in it at `corner` (h).
Case in_domain(Case c, const pbf::Double3& size, const pbf::Double3& corner) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (c.scene.dimensions == 2 && k == 1) continue;
    c.scene.domain.max[k] = c.scene.domain.min[k] + c.scene.h() * size[k];
    for (auto& x : c.particles.position) x[k] += c.scene.h() * corner[k];
  }
  return here(c);
}

/// 100 updates, whose loads must be the weight less the change of momentum.
void check_all_loads(const Case& c) {
  auto solver = make(c);
  const pbf::Plan plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  const double mass = plan.mass * double(plan.particles), time = 100 * c.scene.time.step;
  const pbf::Diagnostics before = solver->diagnose();
  solver->step(100);
  const pbf::Diagnostics after = solver->diagnose();
  double sum[3] = {0, 0, 0}, weight = 0;
  for (const WallLoad& l : loads_of(c, *solver)) {
    for (int k = 0; k < 3; ++k) sum[k] += l.force[k];
    CAPTURE(l.wall);
    if (l.wall[0] == 'o') CHECK(l.peak > 0.01 * mass);
    for (const double t : l.torque) CHECK(std::fabs(t) <= 0.5 * l.peak);  // m
  }
  for (const double g : c.scene.gravity) weight += mass * mass * g * g;
  // Gravity has acted until the time of the velocities.
  const double fallen = time - after.velocity_lag + before.velocity_lag;
  double error = 0;
  for (std::size_t k = 0; k < 3; ++k)
    error = std::max(error, std::fabs(sum[k] - mass * c.scene.gravity[k] * fallen / time +
                                      (after.momentum[k] - before.momentum[k]) / time));
  CHECK(error / std::sqrt(weight) < (is_double() ? 1e-9 : 2e-4));
}

/// Advances in parts and holds every particle to be outside of obstacles after each.
void run_outside(const Case& c, pbf::Solver& s, int updates, int parts, int level = 0) {
  double most = -1e9;
  for (int k = 0; k < parts; ++k) {
    s.step(updates / parts, {.level = level});
    most = std::max(most, deepest(c, places_of(s)));
  }
  CHECK(most < fine());
  CHECK(most > -0.5);  // they did meet it
  const pbf::Diagnostics m = s.diagnose();
  CHECK(m.outside == 0);
  CHECK(m.non_finite == 0);
  CHECK(m.penetration < fine());
}

}  // namespace

TEST_CASE("loads on walls and obstacles are the weight less the change of momentum") {
  Case c = splash(GENERATE(false, true));
  SECTION("defaults") {}
  SECTION("substeps") {
    c.scene.solver.substeps = 3;
    c.scene.solver.iterations = 1;
  }
  SECTION("bare surfaces") { c.scene.solver.boundary = pbf::BoundaryMode::clamp; }
  SECTION("the paper's kernels, tensile, viscosity, Chebyshev's steps") {
    c.scene.solver.kernels = pbf::KernelMode::paper;
    c.scene.tensile = pbf::Tensile{0.002, 0.3, 4};
    c.scene.viscosity = pbf::Viscosity{0.1};
    c.scene.solver.method = pbf::SolverMethod::chebyshev;
  }
  check_all_loads(c);
}

TEST_CASE("a mesh too has loads that are the weight less the change of momentum") {
  Case c = splash(false);
  pbf::Obstacle& o = c.scene.obstacles[0];
  o.shape = pbf_test::mesh_obstacle(pbf_test::box_of(o)).shape;
  SECTION("defaults") {}
  SECTION("substeps") {
    c.scene.solver.substeps = 3;
    c.scene.solver.iterations = 1;
  }
  check_all_loads(c);
}

TEST_CASE("with levels too loads are the weight less the change of momentum", "[slow]") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_block(22, 40, 0.1, 0.3) : jittered_block(12, 10, 26, 0.1, 0.3);
  for (std::size_t k = 0; k < 3; ++k)
    if (!flat || k != 1) c.scene.domain.max[k] = c.scene.domain.min[k] + (k == 2 ? 1.2 : 0.47);
  if (!flat) c.scene.domain.max[0] = c.scene.domain.min[0] + 0.25;
  if (!flat) c.scene.domain.max[1] = c.scene.domain.min[1] + 0.21;
  c.scene.gravity = {1.1, flat ? 0 : -0.6, -9.81};
  c.scene.time.step = 0.002;
  c.scene.domain.loads = true;
  c.scene.solver.iterations = 2;
  c.scene.solver.levels = pbf::LevelsMode::on;
  Placing(c.scene).box({1, 1, 1}, {2.6, 2.4, 2.2}, {0, 1, 0}, 20);
  c = without_inner(here(c), 0.2);
  check_all_loads(c);
  const auto energy = [&] {
    auto solver = make(c);
    solver->step(100);
    return solver->diagnose().kinetic_energy;
  };
  const double with = energy();
  c.scene.solver.levels = pbf::LevelsMode::off;
  CHECK(std::fabs(energy() - with) > 0.01 * with);  // they do act
}

TEST_CASE("a submerged cube of 8 spacings is lifted by what it displaces, and not pushed aside",
          "[slow]") {
  Case c = jittered_block(18, 18, 18, 0, 0);
  const double d = c.scene.fluid.spacing, edge = 8 * d;
  for (std::size_t k = 0; k < 3; ++k)
    c.scene.domain.max[k] = c.scene.domain.min[k] + (k == 2 ? 22 : 18) * d;
  c.scene.precision = pbf::Precision::single;
  Placing(c.scene).box({2.5, 2.5, 2.5}, {6.5, 6.5, 6.5});
  c = without_inner(here(c), 0.1);
  REQUIRE(c.particles.size() == 18 * 18 * 18 - 8 * 8 * 8);
  auto s = make(c);
  s->step(150);
  s->readings(Series::measures, pbf::Interval::ends);
  s->step(250);
  const auto load = loads_of(c, *s, pbf::Interval::ends);
  REQUIRE(load.size() == 1);
  const double lift = 1000 * 9.81 * edge * edge * edge;
  CAPTURE(load[0].force[0] / lift, load[0].force[1] / lift, load[0].force[2] / lift);
  CHECK(load[0].force[2] == Approx(lift).epsilon(0.07));
  CHECK(std::fabs(load[0].force[0]) < 0.01 * lift);
  CHECK(std::fabs(load[0].force[1]) < 0.01 * lift);
  for (const double t : load[0].torque) CHECK(std::fabs(t) < 0.01 * lift * edge);
}

TEST_CASE("a partition between two depths of water carries the difference of their thrusts",
          "[slow]") {
  // 0.4 m and 0.2 m, each 0.2 m long, d = 20 mm, 4 layers wide; the partition is one spacing thick.
  Case c = jittered_block(21, 4, 20, 0, 0);
  pbf::Scene& s = c.scene;
  const double d = s.fluid.spacing, x0 = s.domain.min[0], z0 = s.domain.min[2], width = 4 * d;
  s.domain.max[0] = x0 + 21 * d, s.domain.max[2] = z0 + 0.5;
  Placing(s).box({5, -9, -9}, {5.5, 9, 99});  // from 0.2 to 0.22 m
  c = without_inner(here(c));
  pbf::Particles water;
  for (const pbf::Double3& x : c.particles.position)
    if (x[0] < x0 + 0.2 || x[2] < z0 + 0.2) water.position.push_back(x);
  water.velocity.resize(water.position.size());
  c.particles = water;
  REQUIRE(c.particles.size() == 10 * 4 * (20 + 10));
  auto solver = make(c);
  solver->step(500);
  solver->readings(Series::measures, pbf::Interval::ends);
  solver->step(500);
  const WallLoad load = loads_of(c, *solver, pbf::Interval::ends).at(0);
  const double thrust = 1000 * 9.81 * (0.4 * 0.4 - 0.2 * 0.2) / 2 * width;
  CAPTURE(load.force[0] / thrust, load.force[1] / thrust, load.force[2] / thrust);
  CHECK(load.force[0] == Approx(thrust).epsilon(0.01));
  CHECK(std::fabs(load.force[1]) < 0.003 * thrust);
  CHECK(std::fabs(load.force[2]) < 0.003 * thrust);
}

TEST_CASE("a box that stands on the floor is pressed down by what is above it, and not aside",
          "[slow]") {
  // 12 x 12 spacings wide and 8 high in water 16 deep: nothing is below it, so it is not lifted.
  Case c = jittered_block(22, 22, 16, 0, 0);
  pbf::Scene& s = c.scene;
  s.fluid.spacing = 0.025;
  for (pbf::Double3& x : c.particles.position)
    for (std::size_t k = 0; k < 3; ++k) x[k] = s.domain.min[k] + 1.25 * (x[k] - s.domain.min[k]);
  const double d = s.fluid.spacing;
  for (std::size_t k = 0; k < 3; ++k) s.domain.max[k] = s.domain.min[k] + 22 * d;
  Placing(s).box({2.5, 2.5, -2}, {8.5, 8.5, 4});
  c = without_inner(here(c));
  REQUIRE(c.particles.size() == 22 * 22 * 16 - 12 * 12 * 8);
  auto solver = make(c);
  solver->step(300);
  solver->readings(Series::measures, pbf::Interval::ends);
  solver->step(500);
  const WallLoad load = loads_of(c, *solver, pbf::Interval::ends).at(0);
  const double weight = 1000 * 9.81 * (12 * d) * (12 * d) * (8 * d);
  CAPTURE(load.force[0] / weight, load.force[1] / weight, load.force[2] / weight);
  CHECK(-load.force[2] == Approx(weight).epsilon(0.01));
  CHECK(std::fabs(load.force[0]) < 0.005 * weight);
  CHECK(std::fabs(load.force[1]) < 0.005 * weight);
}

TEST_CASE("a plate of 0.25 h holds fluid on its side for 2000 updates", "[slow]") {
  const bool turned = GENERATE(false, true);
  Case c = in_domain(jittered_block(5, 5, 7, 0.1, 0.3), {5, 2.5, 5}, {0, 0, 0});
  c.scene.gravity = {8, 0, -9.81};
  int level = 0;
  SECTION("an update is a step") {}
  SECTION("substeps") { c.scene.solver.substeps = 2; }
  SECTION("4 steps in an update") { level = 2; }
  const double high = turned ? 20 : 9;
  Placing(c.scene).box({3.4, -2, 2.5 - high}, {3.65, 6, 2.5 + high}, {0, 1, 0}, turned ? 8 : 0);
  auto s = make(c);
  run_outside(c, *s, level ? 500 : 2000, 5, level);
  const oracle::Solid plate = oracle_solids(c.scene)[0];
  const pbf::Snapshot snap = places_of(*s);
  const auto x = snap.fields[0].as<double>();
  int behind = 0;
  for (std::size_t i = 0; i < snap.count; ++i) {
    long double across = 0;
    for (std::size_t k = 0; k < 3; ++k)
      across += plate.axes[0][k] * (x[3 * i + k] - plate.center[k]);
    behind += across > 0;
  }
  CHECK(behind == 0);
}

TEST_CASE("fluid that falls onto crossed ramps, into a wedge, through a gap stays outside",
          "[slow]") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_block(16, 24, 0.1, 0.3) : jittered_block(10, 6, 12, 0.1, 0.3);
  c = in_domain(c, {flat ? 9.0 : 6.0, 3.2, 14}, {0.4, 0, 5});
  c.scene.gravity = {0.5, 0, -9.81};
  c.scene.time.step = 0.004;
  Placing put(c.scene);
  const double middle = flat ? 4.5 : 3;
  SECTION("crossed ramps") {
    put.box({-3, -2, 2.8}, {9, 6, 3.1}, {0, 1, 0}, 35);
    put.box({-3, -2, 2.8}, {9, 6, 3.1}, {0, 1, 0}, -35);
  }
  SECTION("a wedge of 20 degrees") {
    put.box({middle - 3, -2, -6}, {middle - 1, 6, 6}, {0, 1, 0}, 10).loads = false;
    put.box({middle + 1, -2, -6}, {middle + 3, 6, 6}, {0, 1, 0}, -10);
    for (pbf::Obstacle& o : c.scene.obstacles)
      pbf_test::box_of(o).min[2] -= 0.04, pbf_test::box_of(o).max[2] -= 0.04;
  }
  SECTION("a gap of one spacing") {
    put.box({-9, -2, 3}, {middle - 0.25, 6, 4});
    put.box({middle + 0.25, -2, 3}, {20, 6, 4});
  }
  SECTION("a gap of one spacing between a ball and a plate, 4 steps in an update") {
    put.sphere({middle, 1.6, 3}, 1.5);
    put.box({middle + 2, -2, 1}, {middle + 2.25, 6, 5});
  }
  c = without_inner(c, 0.2);
  REQUIRE(c.particles.size() > 300);
  auto s = make(c);
  const bool fine_steps = pbf_test::shape_of(c.scene.obstacles[0]) == ObstacleShape::sphere;
  run_outside(c, *s, fine_steps ? 60 : 200, 10, fine_steps ? 2 : 0);
}

TEST_CASE("a block at 100 h a step is stopped by a plate, a ball and the edge of a box") {
  const bool flat = GENERATE(false, true), iterate = GENERATE(false, true);
  Case c = flat ? flat_block(12, 12, 0.3, 0) : jittered_block(6, 6, 6, 0.3, 0);
  c = in_domain(c, {30, flat ? 0.5 : 12, 30}, {1, flat ? 0.0 : 4, 13});
  c.scene.gravity = {0, 0, 0};
  c.particles.velocity.assign(c.particles.size(), per_step(c.scene, {100, 0, 3}));
  Placing put(c.scene);
  bool closed = false;
  SECTION("a plate") {
    put.box({15, -1, -1}, {15.1, 40, 40});
    closed = true;
  }
  SECTION("a ball") { put.sphere({17, 5.5, 15}, 5); }
  SECTION("the edge of a box") { put.box({13, 1, 13}, {18, 10, 18}, {0, 1, 0}, 45); }
  SECTION("a capsule") { put.tube(ObstacleShape::capsule, {15, 5, 12}, {15, 5, 20}, 2); }
  if (!iterate) c.scene.solver.iterations = 0;
  const auto solids = oracle_solids(c.scene);
  auto s = make(c);
  std::vector<double> before;
  for (const auto& x : c.particles.position) before.insert(before.end(), x.begin(), x.end());
  bool met = false;  // whether anything would fly through it
  for (std::size_t i = 0; i < before.size(); i += 3)
    for (double t = 0; t < 1; t += 1 / 2048.) {
      double at[3];
      for (std::size_t a = 0; a < 3; ++a)
        at[a] = before[i + a] + t * c.scene.time.step * c.particles.velocity[i / 3][a];
      met = met || depth_in(solids, c.scene, at) > 0.04;
    }
  CHECK(met);
  for (int k = 0; k < 6; ++k) {
    s->step(1);
    const pbf::Snapshot snap = places_of(*s);
    const auto x = snap.fields[0].as<double>();
    const double most = deepest(c, snap);
    CHECK(most < fine());
    // Without iterations an update is one path: no place of the way from its start to its end is
    // in the solid, for that is convex.
    double through = -1e9;
    for (std::size_t i = 0; !iterate && i < before.size(); i += 3)
      for (double t = 0; t < 1; t += 1 / 256.) {
        double at[3];
        for (std::size_t a = 0; a < 3; ++a) at[a] = before[i + a] + t * (x[i + a] - before[i + a]);
        through = std::max(through, depth_in(solids, c.scene, at));
      }
    CHECK(through < fine());
    before.assign(x.begin(), x.end());
    for (std::size_t i = 0; closed && i < before.size(); i += 3)
      REQUIRE(x[i] <= pbf_test::box_of(c.scene.obstacles[0]).min[0] + fine() * c.scene.h());
  }
}
