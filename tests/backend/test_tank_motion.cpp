// A tank that moves: closed forms, what the guard makes of its work, and the bits of all ways to
// make the same updates; on every backend and precision.
#include <cmath>
#include <map>

#include "lib/program/motion.h"
#include "lib/run/monitor.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"
#include "tests/support/quaternion.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::same_particles;
using pbf::Double3;

namespace {

constexpr double kPi = 3.14159265358979323846;

pbf::TankMotion turning(const Double3& axis, double degrees, double period) {
  pbf::TankMotion m;
  m.axis = axis;
  m.amplitude = degrees;
  m.period = period;
  return m;
}
pbf::TankMotion by_table(int columns, std::vector<double> time,
                         std::vector<std::array<double, 6>> values) {
  pbf::TankMotion m;
  m.kind = pbf::TankMotionKind::file;
  m.path = "table.csv";
  m.table = {"table.csv", "", columns, std::move(time), std::move(values)};
  return m;
}

/// Particles far apart in a box without walls.
Case free_particles(bool flat) {
  Case c = flat ? flat_block(2, 2, 0, 0) : jittered_block(2, 2, 2, 0, 0);
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const double k = double(i + 1);
    for (std::size_t a = 0; a < 3; ++a)
      if (!flat || a != 1) c.particles.position[i][a] += 0.3 * std::sin(k * double(a + 2));
    c.particles.velocity[i] = {0.3 * k, flat ? 0 : -0.2, 1 - 0.4 * k};
  }
  c.scene.domain.min = {-3, flat ? 0.3 : -3, -5};
  c.scene.domain.max = {3, flat ? 0.32 : 3, 1};
  if (flat)
    for (auto& x : c.particles.position) x[1] = *c.scene.plane();
  c.scene.domain.open = {"x_min", "x_max", "z_min", "z_max"};
  if (!flat) c.scene.domain.open.insert(c.scene.domain.open.end(), {"y_min", "y_max"});
  return here(c);
}

/// Heights of the fluid's surface over a line or a plane: places x, y and the highest particle.
struct Top {
  double x, y, z;
};
std::vector<Top> surface(const Case& c, pbf::Solver& s, double width) {
  const auto snap = s.download({}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>();
  std::map<std::pair<int, int>, Top> highest;
  const auto& lo = c.scene.domain.min;
  for (std::size_t i = 0; i < snap.count; ++i) {
    const double* p = &x[3 * i];
    const std::pair<int, int> column{int((p[0] - lo[0]) / width), int((p[1] - lo[1]) / width)};
    Top& top = highest.try_emplace(column, Top{0, 0, -1e9}).first->second;
    if (p[2] > top.z) top = {p[0], p[1], p[2]};
  }
  std::vector<Top> all;
  for (const auto& [column, top] : highest) all.push_back(top);
  return all;
}
/// Slope of z over f(top), least squares.
template <class F>
double slope(const std::vector<Top>& tops, F&& f) {
  double n = double(tops.size()), a = 0, z = 0, aa = 0, az = 0;
  for (const Top& t : tops) a += f(t), z += t.z, aa += f(t) * f(t), az += f(t) * t.z;
  return (n * az - a * z) / (n * aa - a * a);
}

Case slosh(bool flat) {
  Case c = flat ? flat_block(24, 10, 0.1, 0.1) : jittered_block(10, 6, 8, 0.1, 0.1);
  c.scene.tank_motion = turning({0, 1, 0}, 12, 0.4);
  c.scene.tank_motion->phase = 30;
  if (!flat) c.scene.tank_motion->axis = Double3{1, 2, 0.5};
  c.scene.viscosity = pbf::Viscosity{};
  return here(c);
}

/// The alarm that ends the run, if any.
std::optional<pbf::Alarm> run_to_end(const Case& c, double& rise) {
  const pbf::Plan plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()));
  auto solver = make(c);
  pbf::EnergyTrack energy;
  pbf::Monitor monitor(c.scene, plan, *solver,
                       [&](pbf::Diagnostics& m, double) { energy.follow(m); });
  pbf::Session session(*solver, {&monitor, &monitor.choosing()}, 10);
  session.use(monitor.options());
  session.run(std::llround(c.scene.time.end / c.scene.time.step));
  rise = monitor.last().energy_rise;
  if (!monitor.event()) return std::nullopt;
  return monitor.event()->alarm;
}

}  // namespace

TEST_CASE("a free particle goes straight in the frame at rest while the tank turns and swings") {
  const bool flat = GENERATE(false, true);
  Case c = free_particles(flat);
  c.scene.time.order = pbf::TimeOrder::first;
  const Double3 axis = flat ? Double3{0, 1, 0} : Double3{2.0 / 7, -3.0 / 7, 6.0 / 7};
  pbf::Scene& s = c.scene;
  s.tank_motion = turning(axis, 70, 0.37);
  s.tank_motion->phase = 25;
  s.tank_motion->pivot = Double3{0.1, s.plane().value_or(-0.2), -1.3};
  const Double3 p = *s.tank_motion->pivot;
  auto solver = make(c);
  const double dt = s.time.step;
  const auto angle = [&](double n) {
    return 70 * kPi / 180 * std::sin(2 * kPi * n * dt / 0.37 + 25 * kPi / 180);
  };
  const int n = 200;
  solver->step(n);
  const auto snap = solver->download({}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>();
  double worst = 0;
  for (std::size_t i = 0; i < snap.count; ++i) {
    Double3 r, back, want;
    for (std::size_t a = 0; a < 3; ++a) {
      r[a] = c.particles.position[i][a] - p[a];
      back[a] = r[a] - dt * c.particles.velocity[i][a];
    }
    const Double3 now = pbf::test::by_quaternion(axis, angle(0), r),
                  before = pbf::test::by_quaternion(axis, angle(-1), back);
    for (std::size_t a = 0; a < 3; ++a)
      want[a] = now[a] + n * (now[a] - before[a]) + s.gravity[a] * dt * dt * n * (n + 1) / 2;
    want = pbf::test::by_quaternion(axis, -angle(n), want);
    for (std::size_t a = 0; a < 3; ++a)
      worst = std::max(worst, std::fabs(x[3 * i + a] - p[a] - want[a]));
  }
  CHECK(worst < (is_double() ? 1e-11 : 1e-3));
}

TEST_CASE(
    "a shaken tank, and one with a constant acceleration, move a free particle the other way") {
  Case c = free_particles(false);
  c.scene.time.order = pbf::TimeOrder::first;
  const bool table = GENERATE(false, true);
  const Double3 a{1.5, -2, 0.5};
  const int n = 100;
  const double dt = c.scene.time.step, t = n * dt;
  if (table) {
    c.scene.tank_motion = by_table(3, {0, 1}, {{a[0], a[1], a[2]}, {a[0], a[1], a[2]}});
  } else {
    c.scene.tank_motion.emplace();
    c.scene.tank_motion->direction = Double3{0, 2, 0};
    c.scene.tank_motion->amplitude = 0.05;
    c.scene.tank_motion->period = 0.3;
  }
  auto solver = make(c);
  solver->step(n);
  const auto snap = solver->download({}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>();
  const auto swing = [&](double s) { return 0.05 * std::sin(2 * kPi * s / 0.3); };
  for (std::size_t i = 0; i < snap.count; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double sum = dt * dt * n * (n + 1) / 2;  // of a constant acceleration
      double want =
          c.particles.position[i][k] + t * c.particles.velocity[i][k] + c.scene.gravity[k] * sum;
      if (table) want -= a[k] * sum;
      if (!table && k == 1) want -= swing(t) + n * swing(-dt);
      CHECK(x[3 * i + k] == Approx(want).margin(is_double() ? 1e-11 : 1e-3));
    }
}

TEST_CASE("under a constant acceleration the level is tilted by it, with levels too", "[slow]") {
  const bool levels = GENERATE(false, true);
  Case c = flat_block(40, 16, 0.05, 0);
  if (levels) {
    c.scene.solver.levels = pbf::LevelsMode::on;
    c.scene.solver.substeps = 4;
    c.scene.solver.iterations = 1;
  }
  c.scene.domain.max[0] = c.scene.domain.min[0] + 0.8;
  c.scene.domain.max[2] = c.scene.domain.min[2] + 0.8;
  c.scene.tank_motion = by_table(3, {0, 10}, {{2, 0, 0}, {2, 0, 0}});
  c.scene.solver.velocity_damping = 0.99;
  c = here(c);
  auto solver = make(c);
  solver->step(2000);
  const auto tops = surface(c, *solver, 0.04);
  const double got = std::atan(slope(tops, [](const Top& t) { return t.x; }));
  CHECK(got * 180 / kPi == Approx(-std::atan(2 / 9.81) * 180 / kPi).margin(0.8));
}

TEST_CASE("a tank that turns steadily shows the parabola, and its fluid comes to rest in it",
          "[slow]") {
  Case c = jittered_block(16, 16, 7, 0.02, 0);
  pbf::Scene& s = c.scene;
  s.domain.max = {s.domain.min[0] + 0.32, s.domain.min[1] + 0.32, s.domain.min[2] + 0.6};
  const double rate = 7;  // 1/s
  s.tank_motion = by_table(1, {0, 5, 10}, {{0}, {5 * rate * 180 / kPi}, {10 * rate * 180 / kPi}});
  s.tank_motion->axis = Double3{0, 0, 1};
  s.solver.velocity_damping = 0.985;
  c = here(c);
  auto solver = make(c);
  solver->step(1500);
  const double x0 = s.domain.min[0] + 0.16, y0 = s.domain.min[1] + 0.16;
  const double k = slope(surface(c, *solver, 0.04), [&](const Top& t) {
    return (t.x - x0) * (t.x - x0) + (t.y - y0) * (t.y - y0);
  });
  CHECK(k == Approx(rate * rate / (2 * 9.81)).epsilon(0.08));
  const pbf::Diagnostics m = solver->diagnose();
  CHECK(std::sqrt(2 * m.kinetic_energy / (0.008 * double(c.particles.size()))) < 0.05);
}

TEST_CASE("a tank in motion: the same bits by any batches, passes, threads and after a resume",
          "[slow]") {
  Case c = slosh(GENERATE(false, true));
  c.scene.solver.substeps = GENERATE(1, 3);
  const int level = GENERATE(0, 1);
  auto one = make(c);
  one->step(300, {.level = level});
  Case other = c;
  other.scene.threads = 1;
  auto many = make(other);
  for (const int n : {1, 7, 90, 2}) many->step(n, {.level = level});
  auto fresh = make(c);
  fresh->set_state(many->state());
  fresh->step(200, {.level = level});
  CHECK(same_particles(one->state(), fresh->state()));
  if (level > 0) return;
  fresh->inspection()->trace();
  fresh->inspection()->step_checked({1e30, 1e30, 1 << 30});
  one->step(2);
  CHECK(same_particles(one->state(), fresh->state()));
}

TEST_CASE("the guard lets a tank slosh, counts its work, and stops it when it is unstable") {
  Case c = here(flat_block(40, 14, 0.02, 0));
  pbf::Scene& s = c.scene;
  s.domain.max[0] = s.domain.min[0] + 0.8;
  s.domain.max[2] = s.domain.min[2] + 0.8;
  s.tank_motion = turning({0, 1, 0}, 6, 1.1);
  s.tank_motion->ramp = 0.5;
  s.time = {0.002, 4, {}, 0};
  double rise = -1;
  const auto calm = run_to_end(c, rise);
  CHECK_FALSE(calm);
  CHECK(rise < 0.02);
  Case wild = c;
  wild.scene.solver.sor = 1.9;
  wild.scene.solver.iterations = 12;
  wild.scene.time.step = 0.004;
  wild.scene.fluid.smoothing_ratio = 3.5;
  CHECK(run_to_end(wild, rise));
}
