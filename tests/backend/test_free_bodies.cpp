// Bodies that the fluid moves: what they conserve, where they float, what they touch, and the bits
// of all ways to make the same updates; on every backend and precision.
#include <cmath>
#include <numbers>

#include "lib/program/plan.h"
#include "tests/support/catch.h"
#include "tests/support/obstacles.h"

using namespace oracle_test;
using namespace obstacle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::same_particles;
using backend_test::Series;
using pbf::BodyMotion;
using pbf::Double3;
using pbf::FreeBody;
using pbf::Scene;

namespace {

FreeBody of_density(double density, const Double3& velocity = {}, const Double3& angular = {}) {
  FreeBody free;
  free.density = density;
  free.velocity = velocity;
  free.angular = angular;
  return free;
}

/// One particle in a corner of an empty box of so many h.
Case empty(double edge) {
  Case c = jittered_block(1, 1, 1, 0, 0);
  for (std::size_t k = 0; k < 3; ++k)
    c.scene.domain.max[k] = c.scene.domain.min[k] + edge * c.scene.h();
  c.particles.position[0] = Placing(c.scene).at({1, 1, 1});
  return c;
}

/// Without walls, and without gravity.
void float_free(Scene& s) {
  s.gravity = {};
  s.domain.open = {"x_min", "x_max", "z_min", "z_max"};
  if (s.dimensions == 3) s.domain.open.insert(s.domain.open.end(), {"y_min", "y_max"});
}

double mass_of_box(const Scene& s, std::size_t k) {
  const auto& box = pbf_test::box_of(s.obstacles[k]);
  double volume = 1;
  for (std::size_t a = 0; a < 3; ++a) volume *= box.max[a] - box.min[a];
  return *s.obstacles[k].free->density * volume;
}

/// What body b is owed, kg m/s: impulses of the fluid that it takes later.
Double3 owed(const Case& c, pbf::Solver& s, std::size_t b = 0) {
  const pbf::Plan plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  const pbf::SolverState state = s.state();
  const pbf::StoredField* bodies = state.find("body states");
  REQUIRE(bodies);
  Double3 out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[std::size_t(plan.axes.of[k])] =
        plan.mass * c.scene.h() * bodies->values.at(b * std::size_t(bodies->numbers) + 13 + k);
  return out;
}

/// A jet of fluid and a body in its way.
Case hit(bool flat) {
  Case c = flat ? flat_block(14, 10, 0.1, 0.1) : jittered_block(8, 6, 7, 0.1, 0.1);
  Scene& s = c.scene;
  for (std::size_t k = 0; k < 3; ++k)
    if (!flat || k != 1) s.domain.max[k] = s.domain.min[k] + 24 * s.h();
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      if (!flat || k != 1) c.particles.position[i][k] += 8 * s.h();
    c.particles.velocity[i][0] += 0.5;
  }
  Placing put(s);
  put.box({16, 8, 9}, {18, 11, 12}, {0, 1, 0}, 10).free = of_density(300);
  return c;
}

}  // namespace

TEST_CASE("a free body alone keeps its velocity and its spin, and turns about its center") {
  Case c = empty(60);
  float_free(c.scene);
  Placing put(c.scene);
  put.box({28, 29, 29.5}, {32, 31, 30.5}).free = of_density(500, {0.1, 0.2, -0.1}, {90, 40, 20});
  c = here(c);
  auto solver = make(c);
  const BodyMotion first = solver->diagnose().bodies.at(0);
  solver->step(500);  // 1 s
  const BodyMotion now = solver->diagnose().bodies.at(0);
  const double h = c.scene.h();
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(now.velocity[k] == Approx(c.scene.obstacles[0].free->velocity[k]).margin(1e-12));
    CHECK(now.middle[k] - first.middle[k] == Approx(now.velocity[k]).margin(1e-9 * h));
  }
  // Angular momentum of a box a x b x c about its axes, along those of the scene.
  const auto momentum = [&](const BodyMotion& m) {
    const double a = 4, b = 2, d = 1;
    const double inertia[3] = {b * b + d * d, a * a + d * d, a * a + b * b};
    Double3 out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Double3 along{};  // column of the rotation
      for (std::size_t k = 0; k < 3; ++k) along[k] = m.turn[k][axis];
      const double part = along[0] * m.spin[0] + along[1] * m.spin[1] + along[2] * m.spin[2];
      for (std::size_t k = 0; k < 3; ++k) out[k] += inertia[axis] * part * along[k];
    }
    return out;
  };
  const Double3 before = momentum(first), after = momentum(now);
  for (std::size_t k = 0; k < 3; ++k) CHECK(after[k] == Approx(before[k]).margin(1e-9));
  CHECK(now.spin != first.spin);  // no axis of the box: it tumbles
}

TEST_CASE("a body that turns about one of its axes has turned by rate times time") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_block(1, 1, 0, 0) : empty(60);
  if (flat)
    for (const std::size_t k : {0, 2})
      c.scene.domain.max[k] = c.scene.domain.min[k] + 60 * c.scene.h();
  float_free(c.scene);
  Placing put(c.scene);
  put.box({28, 29, 29.5}, {32, 31, 30.5}).free = of_density(500, {}, {0, 90, 0});
  c = here(c);
  auto solver = make(c);
  solver->step(500);
  const BodyMotion now = solver->diagnose().bodies.at(0);
  CHECK(std::atan2(now.turn[0][2], now.turn[0][0]) == Approx(std::numbers::pi / 2).margin(1e-5));
  CHECK(now.spin[1] == Approx(std::numbers::pi / 2).margin(1e-9));
}

TEST_CASE("fluid and a free body keep their momentum together to rounding, with what it is owed") {
  const bool flat = GENERATE(false, true);
  Case c = hit(flat);
  c.scene.time.order = GENERATE(pbf::TimeOrder::first, pbf::TimeOrder::second);
  float_free(c.scene);
  c = here(c);
  auto solver = make(c);
  const double mass = mass_of_box(c.scene, 0);
  const auto total = [&](std::size_t k) {
    const pbf::Diagnostics m = solver->diagnose();
    return m.momentum[k] + mass * m.bodies.at(0).velocity[k] + owed(c, *solver)[k];
  };
  Double3 before{};
  for (std::size_t k = 0; k < 3; ++k) before[k] = total(k);
  solver->step(300);
  const double size = std::fabs(before[0]);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(total(k) == Approx(before[k]).margin((is_double() ? 1e-9 : 1e-4) * size));
  CHECK(mass * solver->diagnose().bodies.at(0).velocity[0] > 0.02 * size);  // it was hit
}

TEST_CASE("a body moves and turns along and about no axis that is locked") {
  Case c = hit(false);
  float_free(c.scene);
  c.scene.obstacles[0].free->lock = {"x", "ry", "rz"};
  c = here(c);
  auto solver = make(c);
  const BodyMotion first = solver->diagnose().bodies.at(0);
  solver->step(200);
  const BodyMotion now = solver->diagnose().bodies.at(0);
  CHECK(now.middle[0] == first.middle[0]);
  CHECK(now.velocity[0] == 0);
  CHECK(now.velocity[2] != 0);
  CHECK(now.spin[0] != 0);
  CHECK(now.spin[1] == 0);
  CHECK(now.spin[2] == 0);
  for (const std::size_t k : {0, 1, 2})
    CHECK(now.turn[0][k] == Approx(k == 0 ? 1 : 0).margin(1e-12));
}

TEST_CASE("a body falls as far as a particle does, and rests on the floor without a bounce") {
  Case c = empty(30);
  Placing put(c.scene);
  put.box({14, 14, 6}, {16, 16, 8}).free = of_density(2000);
  put.sphere({6, 6, 20}, 2).free = of_density(2000);
  c = here(c);
  auto solver = make(c);
  const double h = c.scene.h(), g = 9.81, fall = std::sqrt(2 * 6 * h / g);
  solver->step(int(0.5 * fall / c.scene.time.step));
  const BodyMotion falling = solver->diagnose().bodies.at(0);
  const double t = double(solver->updates()) * c.scene.time.step;
  CHECK(falling.velocity[2] == Approx(-g * t).epsilon(1e-6));
  solver->step(1500);
  const auto bodies = solver->diagnose().bodies;
  const double fine = is_double() ? 1e-6 : 1e-4;
  CHECK(bodies.at(0).middle[2] - c.scene.domain.min[2] == Approx(h).margin(fine * h));
  CHECK(bodies.at(1).middle[2] - c.scene.domain.min[2] == Approx(2 * h).margin(fine * h));
  for (const BodyMotion& b : bodies) {
    CHECK(std::fabs(b.velocity[2]) < 1e-4);
    CHECK(b.turn[2][2] == Approx(1).margin(1e-6));
  }
}

TEST_CASE("a box that lands on an edge falls over and rests on a face") {
  Case c = empty(30);
  Placing put(c.scene);
  put.box({13, 13, 6}, {17, 17, 8}, {0, 1, 0}, 50).free = of_density(2000);
  c = here(c);
  auto solver = make(c);
  solver->step(2000);
  const pbf::Diagnostics m = solver->diagnose();
  const BodyMotion& b = m.bodies.at(0);
  const double low = (b.middle[2] - c.scene.domain.min[2]) / c.scene.h();
  CHECK(low == Approx(1).margin(0.02));
  CHECK(std::fabs(b.spin[1]) < 1e-3);
}

TEST_CASE("bodies that meet keep their momentum and stay out of each other and of obstacles") {
  Case c = empty(60);
  float_free(c.scene);
  Placing put(c.scene);
  put.box({20, 28, 28}, {24, 32, 32}).free = of_density(500, {1, 0, 0});
  put.sphere({32, 30, 30}, 2).free = of_density(500);
  put.box({44, 20, 20}, {46, 40, 40});
  c = here(c);
  auto solver = make(c);
  const double h = c.scene.h();
  const double box = mass_of_box(c.scene, 0),
               ball = 500 * 4.0 / 3 * std::numbers::pi * std::pow(2 * h, 3);
  double deepest = 0, nearest = 1e9;
  for (int k = 0; k < 100; ++k) {
    solver->step(10);
    const auto b = solver->diagnose().bodies;
    const double left = (b.at(0).middle[0] - c.scene.domain.min[0]) / h,
                 right = (b.at(1).middle[0] - c.scene.domain.min[0]) / h;
    nearest = std::min(nearest, right - left);
    deepest = std::max(deepest, right + 2 - 44);
    if (right < 41.5) {
      const double sum = box * b[0].velocity[0] + ball * b[1].velocity[0];
      CHECK(sum == Approx(box * 1).epsilon(1e-9));
    }
  }
  CHECK(deepest > -0.01);  // it arrived
  CHECK(deepest < 0.02);
  CHECK(nearest > 4 - 0.05);
  CHECK(nearest < 4.5);
}

TEST_CASE("free bodies: the same bits by any batches, threads and after a resume", "[slow]") {
  Case c = hit(GENERATE(false, true));
  c.scene.solver.substeps = GENERATE(1, 3);
  const int level = GENERATE(0, 1);
  c = here(c);
  auto one = make(c);
  one->step(300, {.level = level});
  auto fresh = by_detours(c, level);
  CHECK(same_particles(one->state(), fresh->state()));
  CHECK(one->diagnose().bodies == fresh->diagnose().bodies);
  CHECK(one->diagnose().solid_work == fresh->diagnose().solid_work);
  if (level > 0) return;
  fresh->inspection()->trace();
  fresh->inspection()->step_checked({1e30, 1e30, 1 << 30});
  one->step(2);
  CHECK(same_particles(one->state(), fresh->state()));
  CHECK(one->diagnose().bodies == fresh->diagnose().bodies);
}

TEST_CASE("steps without time leave free bodies where they are") {
  Case c = here(hit(false));
  auto solver = make(c);
  solver->step(50);
  const auto before = solver->diagnose().bodies;
  solver->step(5, {.without_time = 1.0});
  CHECK(solver->diagnose().bodies == before);
}

TEST_CASE("fluid and bodies together gain at most a twentieth of their energy in a splash",
          "[slow]") {
  const bool flat = GENERATE(false, true);
  const double density = GENERATE(50.0, 500.0, 3000.0);
  Case c = flat ? flat_block(20, 12, 0.02, 0) : jittered_block(10, 8, 8, 0.02, 0);
  Scene& s = c.scene;
  s.domain.max[0] = s.domain.min[0] + (flat ? 20 : 12) * s.h();
  if (!flat) s.domain.max[1] = s.domain.min[1] + 4 * s.h();
  s.domain.max[2] = s.domain.min[2] + 12 * s.h();
  s.time.end = 1;
  Placing put(s);
  put.box({3, 1, 7}, {5, 3, 9}, {0, 1, 0}, 20).free = of_density(density);
  c = without_inner(here(c), 0.2);
  auto solver = make(c);
  pbf::WorkTrack work;
  pbf::EnergyTrack energy;
  pbf::Diagnostics m;
  for (int k = 0; k <= 50; ++k) {
    if (k > 0) solver->step(10);
    m = solver->diagnose();
    m.work = work.until(m);
    solver->readings(Series::measures, pbf::Interval::ends);
    work.take(m);
    energy.follow(m);
  }
  CHECK(m.outside == 0);
  CHECK(m.non_finite == 0);
  CHECK(m.energy_rise < 0.05);
}

TEST_CASE("a body of a twentieth of the density of water does not bounce off it as it fell") {
  Case c = flat_block(34, 11, 0.02, 0);
  Scene& s = c.scene;
  const double d = s.fluid.spacing;
  s.domain.max[0] = s.domain.min[0] + 34 * d;
  s.domain.max[2] = s.domain.min[2] + 44 * d;
  Placing put(s);
  put.box({7, 0, 6.3}, {8.5, 1, 7.8}, {0, 1, 0}, 57).free = of_density(50, {0.8, 0, -3});
  c = here(c);
  auto solver = make(c);
  double down = 0, up = 0;
  for (int k = 0; k < 60; ++k) {
    solver->step(2);
    const double v = solver->diagnose().bodies.at(0).velocity[2];
    down = std::min(down, v), up = std::max(up, v);
  }
  CHECK(down < -3);
  CHECK(up < 1.5);
}

TEST_CASE("a closed body under water of a twentieth of its density does not burst", "[slow]") {
  Case c = flat_block(20, 16, 0.02, 0);
  Scene& s = c.scene;
  s.domain.max[0] = s.domain.min[0] + 20 * s.fluid.spacing;
  s.domain.max[2] = s.domain.min[2] + 24 * s.fluid.spacing;
  Placing put(s);
  put.box({3.5, 0, 2}, {6, 1, 4.5}).free = of_density(50);
  c = without_inner(here(c), 0.2);
  auto solver = make(c);
  double fastest = 0;
  for (int k = 0; k < 50; ++k) {
    solver->step(10);
    fastest = std::max(fastest, std::fabs(solver->diagnose().bodies.at(0).velocity[2]));
  }
  // It rises by its buoyancy, less the mass of the fluid that it carries along, and jumps.
  CHECK(fastest < 3 * std::sqrt(2 * 9.81 * 16 * s.fluid.spacing));
  CHECK(solver->diagnose().bodies.at(0).middle[2] > s.domain.min[2] + 10 * s.fluid.spacing);
  CHECK(solver->diagnose().outside == 0);
}

TEST_CASE("a box floats as deep as Archimedes says", "[slow]") {
  const double density = GENERATE(300.0, 700.0);
  Case c = flat_block(40, 20, 0.01, 0);
  Scene& s = c.scene;
  const double d = s.fluid.spacing;
  s.domain.max[0] = s.domain.min[0] + 40 * d;
  s.domain.max[2] = s.domain.min[2] + 40 * d;
  s.solver.velocity_damping = 0.995;
  const double edge = 10 * d, draft = density / 1000 * edge, level = 20 * d;
  const double low = (level - draft) / s.h();
  Placing put(s);
  put.box({15 * d / s.h(), 0, low}, {25 * d / s.h(), 1, low + edge / s.h()}).free =
      of_density(density);
  const auto poured = double(c.particles.size());
  c = without_inner(here(c), 0.2);
  auto solver = make(c);
  solver->step(1500);
  double mean = 0;
  for (int k = 0; k < 50; ++k) {
    solver->step(10);
    mean += solver->diagnose().bodies.at(0).middle[2] / 50;
  }
  // The surface, from the volume of fluid and of the part of the body that is under water.
  const double volume = double(c.particles.size()) * d * d + draft * edge;
  const double surface = s.domain.min[2] + volume / (40 * d);
  CHECK(poured > double(c.particles.size()));
  CHECK(surface - (mean - edge / 2) == Approx(draft).margin(0.05 * edge));
}
