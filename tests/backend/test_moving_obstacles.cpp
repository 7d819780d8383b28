// Obstacles that move: what they push, that nothing gets in or through, loads and work, and the
// bits of all ways to make the same updates; on every backend and precision.
#include <cmath>

#include "kernels/boundary/obstacle.h"
#include "lib/program/motion.h"
#include "lib/program/obstacles.h"
#include "tests/support/catch.h"
#include "tests/support/obstacles.h"

using namespace oracle_test;
using namespace obstacle_test;
using backend_test::check_loads;
using backend_test::here;
using backend_test::is_double;
using backend_test::loads_of;
using backend_test::same_particles;
using backend_test::Series;
using backend_test::WallLoad;
using pbf::Double3;
using pbf::Motion;
using pbf::MotionKind;

namespace {

Motion going(const Double3& velocity, const Double3& angular = {}) {
  Motion m;
  m.kind = MotionKind::velocity;
  m.velocity = velocity;
  m.angular = angular;
  return m;
}
Motion swinging(const Double3& direction, double amplitude, double period) {
  Motion m;
  m.direction = direction;
  m.amplitude = amplitude;
  m.period = period;
  return m;
}

/// h, of the deepest particle in an obstacle as it stands at the time of the solver.
double deepest_now(const Case& c, pbf::Solver& s) {
  const auto snap = places_of(s);
  const auto x = snap.fields[0].as<double>();
  const auto solids = pbf::solids_of(c.scene, double(s.updates()) * c.scene.time.step);
  const Double3 from = c.scene.origin();
  double most = -1e9;
  for (std::size_t i = 0; i < snap.count; ++i) {
    pbf::Vec3<double> p{(x[3 * i] - from[0]) / c.scene.h(), (x[3 * i + 1] - from[1]) / c.scene.h(),
                        (x[3 * i + 2] - from[2]) / c.scene.h()};
    for (const auto& o : solids)
      most = std::max(most,
                      -(c.scene.dimensions == 2 ? pbf::distance<2>(o, p) : pbf::distance<3>(o, p)));
  }
  return most;
}

/// A box that swings in a splash, and a turning one.
Case stirred(bool flat) {
  Case c = flat ? flat_block(16, 14, 0.1, 0.2) : jittered_block(9, 6, 9, 0.1, 0.2);
  pbf::Scene& s = c.scene;
  s.domain.max[0] = s.domain.min[0] + (flat ? 0.5 : 0.3);
  if (!flat) s.domain.max[1] = s.domain.min[1] + 0.16;
  s.domain.max[2] = s.domain.min[2] + 0.5;
  s.domain.loads = true;
  Placing put(s);
  put.box({2, 0.5, 1}, {2.6, 3, 3}).motion = swinging({1, 0, 0.3}, 0.03, 0.3);
  put.box({4.5, 1.7, 1.2}, {6.5, 2.4, 1.7}).motion =
      going({0, 0, 0}, flat ? Double3{0, 400, 0} : Double3{100, 300, 50});
  put.sphere({1.2, 1.5, 6}, 1.1);
  return without_inner(here(c), 0.2);
}

}  // namespace

TEST_CASE("a wall that comes takes a particle along at its speed") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_block(1, 1, 0, 0) : jittered_block(1, 1, 1, 0, 0);
  c.scene.gravity = {};
  for (std::size_t k = 0; k < 3; ++k)
    if (!flat || k != 1) c.scene.domain.max[k] = c.scene.domain.min[k] + 0.8;
  Placing put(c.scene);
  c.particles.position[0] = put.at({10, 10, 10});
  put.box({6, 8, 8}, {8, 12, 12}).motion = going({0.4, 0, 0});
  c.scene.solver.boundary = pbf::BoundaryMode::clamp;
  c = here(c);
  auto solver = make(c);
  const int met = 100;  // 2 h, 0.08 m, at 0.4 m/s
  solver->step(met - 10);
  CHECK(solver->diagnose().speed_max == 0);
  solver->step(60);
  const auto snap = solver->download({"velocity"}, pbf::ScalarType::f64).get();
  const double exact = is_double() ? 1e-11 : 1e-4;
  CHECK(snap.find("velocity")->as<double>()[0] == Approx(0.4).margin(exact));
  CHECK(snap.fields[0].as<double>()[0] ==
        Approx(pbf_test::box_of(c.scene.obstacles[0]).max[0] + 0.4 * 0.002 * 150).margin(exact));
}

TEST_CASE("the torque on an obstacle that moves is about where its middle is then") {
  Case c = jittered_block(1, 1, 1, 0, 0);
  c.scene.gravity = {};
  for (std::size_t k = 0; k < 3; ++k) c.scene.domain.max[k] = c.scene.domain.min[k] + 0.8;
  Placing put(c.scene);
  c.particles.position[0] = put.at({10, 10.5, 11});
  put.box({6, 6, 6}, {8, 14, 14}).motion = going({0.4, 0, 0.2});
  c.scene.solver.boundary = pbf::BoundaryMode::clamp;
  c = here(c);
  auto solver = make(c);
  solver->step(150);
  const WallLoad l = loads_of(c, *solver)[0];
  const double h = c.scene.h(), when = 2 * h / 0.4;
  CHECK(l.force[0] < 0);
  CHECK(l.torque[1] / l.force[0] == Approx(h - 0.2 * when).margin(1e-3));
  CHECK(l.torque[2] / l.force[0] == Approx(-0.5 * h).margin(1e-3));
}

TEST_CASE("a plate of 0.25 h that goes by 3 h a step takes all that is in its way along") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_block(6, 6, 0.2, 0) : jittered_block(5, 5, 5, 0.2, 0);
  pbf::Scene& s = c.scene;
  s.gravity = {};
  s.domain.max[0] = s.domain.min[0] + 60 * s.h();
  s.time.step = 0.001;
  Placing put(s);
  for (auto& x : c.particles.position) x[0] += 5 * s.h();
  put.box({3, -1, -1}, {3.25, 50, 50}).motion = going({3 * s.h() / 0.001, 0, 0});
  pbf_test::box_of(s.obstacles[0]).min[1] = s.domain.min[1] - 1,
  pbf_test::box_of(s.obstacles[0]).max[1] = s.domain.max[1] + 1;
  c = here(c);
  auto solver = make(c);
  for (int k = 1; k <= 12; ++k) {
    solver->step(1);
    const auto snap = places_of(*solver);
    const auto x = snap.fields[0].as<double>();
    const double face = s.domain.min[0] + (3.25 + 3 * k) * s.h();
    for (std::size_t i = 0; i < snap.count; ++i) REQUIRE(x[3 * i] > face - 1e-4 * s.h());
  }
}

TEST_CASE("nothing gets into a stirrer in 10000 updates, or what it may gain is its work",
          "[slow]") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_block(20, 10, 0.05, 0) : jittered_block(8, 8, 5, 0.05, 0);
  pbf::Scene& s = c.scene;
  for (std::size_t k = 0; k < 3; ++k)
    if (!flat || k == 0) s.domain.max[k] = s.domain.min[k] + (flat ? 0.4 : k == 2 ? 0.3 : 0.16);
  s.domain.max[2] = s.domain.min[2] + 0.4;
  s.time.end = 20;
  s.time.order = pbf::TimeOrder::first;  // the second releases more of the start's compression
  Placing put(s);
  const double middle = flat ? 5 : 2;
  put.box({middle - 1.6, middle - 0.2, 0.6}, {middle + 1.6, middle + 0.2, 1.6}).motion =
      going({}, flat ? Double3{0, 360, 0} : Double3{0, 0, 360});
  if (flat)
    pbf_test::box_of(s.obstacles[0]).min[2] = s.domain.min[2] + 0.08,
    pbf_test::box_of(s.obstacles[0]).max[2] = s.domain.min[2] + 0.1;
  c = without_inner(here(c), 0.2);
  auto solver = make(c);
  double most = -1e9;
  pbf::WorkTrack work;
  pbf::EnergyTrack energy;
  pbf::Diagnostics m;
  for (int k = 0; k <= 500; ++k) {
    if (k > 0) solver->step(20);
    most = std::max(most, deepest_now(c, *solver));
    m = solver->diagnose();
    m.work = work.until(m);
    solver->readings(Series::measures, pbf::Interval::ends);
    work.take(m);
    energy.follow(m);
  }
  CHECK(most < 10 * fine());
  CHECK(most > -0.2);
  CHECK(m.outside == 0);
  CHECK(m.non_finite == 0);
  CHECK(m.work > 0.02 * m.energy);  // it did stir
  CHECK(m.energy_rise < 0.02);
}

TEST_CASE(
    "a piston lifts what it displaces, and loads are the weight less the change of momentum") {
  Case c = flat_block(30, 8, 0.02, 0);
  pbf::Scene& s = c.scene;
  s.domain.max[0] = s.domain.min[0] + 0.6;
  s.domain.max[2] = s.domain.min[2] + 0.4;
  s.domain.loads = true;
  Placing put(s);
  pbf::Obstacle& piston = put.box({-6, 0, -1}, {0, 0, 30});
  piston.motion = swinging({1, 0, 0}, 0.1, 8);  // 0.1 m in 2 s
  s.time.end = 2;
  c = here(c);
  auto solver = make(c);
  const double mass = 0.02 * 0.02 * 0.02 * 1000 * double(c.particles.size());
  const double before = solver->diagnose().center_of_mass[2] - s.domain.min[2];
  for (int k = 0; k < 10; ++k) {
    const pbf::Diagnostics a = solver->diagnose();
    solver->readings(Series::measures, pbf::Interval::ends);
    solver->step(100);
    const pbf::Diagnostics b = solver->diagnose();
    for (const int axis : {0, 2}) {
      double force = 0;
      for (const WallLoad& l : loads_of(c, *solver)) force += l.force[axis];
      // Gravity has acted until the time of the velocities.
      const double fallen = 0.2 - b.velocity_lag + a.velocity_lag;
      const double want =
          (mass * s.gravity[std::size_t(axis)] * fallen - (b.momentum[axis] - a.momentum[axis])) /
          0.2;
      CHECK(force == Approx(want).margin((is_double() ? 1e-9 : 2e-4) * mass * 9.81));
    }
  }
  const double after = solver->diagnose().center_of_mass[2] - s.domain.min[2];
  CHECK(after / before == Approx(0.6 / 0.5).epsilon(0.03));
  CHECK(deepest_now(c, *solver) < fine());
}

TEST_CASE("obstacles in motion: the same bits by any batches, passes, threads and after a resume",
          "[slow]") {
  Case c = stirred(GENERATE(false, true));
  c.scene.solver.substeps = GENERATE(1, 3);
  const int level = GENERATE(0, 1);
  auto one = make(c);
  one->step(300, {.level = level});
  auto fresh = by_detours(c, level);
  CHECK(same_particles(one->state(), fresh->state()));
  check_loads(*fresh, one->readings(Series::measures, pbf::Interval::goes_on));
  CHECK(one->diagnose().solid_work == fresh->diagnose().solid_work);
  CHECK(one->diagnose().solid_work != 0);
  if (level > 0) return;
  fresh->inspection()->trace();
  fresh->inspection()->step_checked({1e30, 1e30, 1 << 30});
  one->step(2);
  CHECK(same_particles(one->state(), fresh->state()));
  check_loads(*fresh, one->readings(Series::measures, pbf::Interval::goes_on));
}

TEST_CASE("steps without time leave obstacles where they are, and do no work") {
  Case c = stirred(false);
  auto solver = make(c);
  solver->step(20);
  const double work = solver->diagnose().solid_work;
  solver->step(5, {.without_time = 1.0});
  CHECK(solver->diagnose().solid_work == work);
  CHECK(deepest_now(c, *solver) < fine());
  solver->step(20);
  CHECK(deepest_now(c, *solver) < fine());
}

TEST_CASE("solids that close a gap over fluid: all of it stays finite and inside the walls") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_block(12, 10, 0.1, 0) : jittered_block(7, 5, 6, 0.1, 0);
  pbf::Scene& s = c.scene;
  Placing put(s);
  const double wide = (s.domain.max[0] - s.domain.min[0]) / s.h();
  put.box({-wide, -1, -1}, {0, 50, 50}).motion = going({0.4, 0, 0});
  put.box({wide, -1, -1}, {2 * wide, 50, 50}).motion = going({-0.4, 0, 0});
  c = here(c);
  auto solver = make(c);
  solver->step(int(wide * s.h() / 0.4 / s.time.step * 0.6));  // they pass each other
  const pbf::Diagnostics m = solver->diagnose();
  CHECK(m.non_finite == 0);
  CHECK(m.outside == 0);
  CHECK(m.penetration > 0.1 * s.h());  // there is no room outside: the measures say so
}
