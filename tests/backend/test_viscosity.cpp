// Viscosity in physical units, and the friction of walls and obstacles, against closed solutions of
// the equation of viscous flow and against integrals of the kernel.
#include <algorithm>
#include <cmath>
#include <functional>

#include "lib/scene/viscosity.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;
using backend_test::loads_of;
using backend_test::Series;
using pbf::Double3;
using pbf::Interval;
using pbf::TimeOrder;

namespace {

constexpr double kSpacing = 0.02;

/// A square lattice that fills nx x nz cells; u(z) along x. Without gravity.
Case layers(int nx, int nz, const std::function<double(double)>& u) {
  Case c;
  c.scene.dimensions = 2;
  c.scene.fluid.spacing = kSpacing;
  c.scene.domain.min = {0, 0, 0};
  c.scene.domain.max = {nx * kSpacing, kSpacing, nz * kSpacing};
  c.scene.domain.periodic = {"x"};
  c.scene.gravity = {0, 0, 0};
  c.scene.time = {0.01, 1, {}};
  for (int z = 0; z < nz; ++z)
    for (int x = 0; x < nx; ++x) {
      const Double3 at{(x + 0.5) * kSpacing, 0.5 * kSpacing, (z + 0.5) * kSpacing};
      c.particles.position.push_back(at);
      c.particles.velocity.push_back({u(at[2]), 0, 0});
    }
  return here(c);
}
void give_viscosity(Case& c, double nu) {
  c.scene.viscosity.emplace();
  c.scene.viscosity->xsph = 0;
  c.scene.viscosity->kinematic = nu;
}

/// sum of u f(z) over sum of f(z)^2, u along x.
double projected(const Case& c, pbf::Solver& s, const std::function<double(double)>& f) {
  const pbf::Snapshot snap = s.download({"velocity"}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), v = snap.find("velocity")->as<double>();
  double product = 0, square = 0;
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const double value = f(x[3 * i + 2]);
    product += v[3 * i] * value, square += value * value;
  }
  return product / square;
}
/// The largest difference of u from f(z).
double farthest_from(const Case& c, pbf::Solver& s, const std::function<double(double)>& f) {
  const pbf::Snapshot snap = s.download({"velocity"}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), v = snap.find("velocity")->as<double>();
  double most = 0;
  for (std::size_t i = 0; i < c.particles.size(); ++i)
    most = std::max(most, std::fabs(v[3 * i] - f(x[3 * i + 2])));
  return most;
}

/// W of the consistent kernel by its definition (Mueller et al. 2003, eq. 21), q in h.
double spiky(double q, bool flat) {
  return q < 1 ? (flat ? 10 : 15) / M_PI * std::pow(1 - q, 3) : 0;
}
/// The integral of z W over a half space at distance q, z the height over it.
double moment_behind(double q, bool flat) {
  constexpr int n = 400;
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const double z = q + (k + 0.5) * (1 - q) / n, widest = std::sqrt(1 - z * z);
    for (int m = 0; m < n; ++m) {
      const double r = (m + 0.5) * widest / n;
      sum += z * spiky(std::hypot(z, r), flat) * (flat ? 2 : 2 * M_PI * r) * widest / n;
    }
  }
  return sum * (1 - q) / n;
}
/// The same sum over the layers of the lattice behind a wall at d/2, h = 2 d.
double lattice_behind(bool flat) {
  double sum = 0, all = 0;
  for (int z = -2; z <= 2; ++z)
    for (int y = -2; y <= 2; ++y)
      for (int x = -2; x <= 2; ++x) {
        if (flat && y != 0) continue;
        const double w = spiky(std::sqrt(double(x * x + y * y + z * z)) / 2, flat);
        all += w;
        if (z > 0) sum += 0.5 * z * w;
      }
  return sum / all;
}

}  // namespace

TEST_CASE("a kinematic viscosity keeps the momentum of torn fluid to rounding") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? flat_block(20, 18, 0.4, 0.5) : jittered_block(8, 7, 8, 0.4, 0.5);
  for (const std::size_t k : {0u, 1u, 2u})
    if (k != 1 || !flat) c.scene.domain.periodic.emplace_back(1, char('x' + k));
  c.scene.gravity = {0, 0, 0};
  const int cells[3] = {flat ? 20 : 8, flat ? 1 : 7, flat ? 18 : 8};
  for (std::size_t k = 0; k < 3; ++k)
    c.scene.domain.max[k] = c.scene.domain.min[k] + cells[k] * c.scene.fluid.spacing;
  c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
  c.scene.solver.substeps = GENERATE(1, 3);
  c.scene.solver.kernels = pbf::KernelMode::consistent;
  give_viscosity(c, 0.05);  // some sweeps
  REQUIRE(pbf::viscous_sweeps(c.scene).sweeps > 2);
  c = here(c);
  auto s = make(c);
  const auto before = s->diagnose();
  s->step(20);
  const auto after = s->diagnose();
  const double mass = c.scene.particle_mass() * double(c.particles.size()),
               scale = std::sqrt(2 * before.kinetic_energy * mass);
  for (int k = 0; k < 3; ++k)
    CHECK(std::fabs(after.momentum[k] - before.momentum[k]) < (is_double() ? 1e-13 : 1e-5) * scale);
  CHECK(after.kinetic_energy < 0.2 * before.kinetic_energy);
}

TEST_CASE("a shear wave decays with the kinematic viscosity, for any step and number of sweeps") {
  const double step = GENERATE(0.0025, 0.01, 0.04), nu = GENERATE(1e-4, 2e-3);
  const int nz = 24;
  const double k = 2 * M_PI / (nz * kSpacing);
  const auto wave = [&](double z) { return 0.1 * std::sin(k * z); };
  Case c = layers(8, nz, wave);
  c.scene.domain.periodic = {"x", "z"};
  c.scene.time.step = step;
  c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
  give_viscosity(c, nu);
  auto s = make(c);
  s->step(8);
  const double start = projected(c, *s, wave);
  const int updates = int(std::lround(0.4 / step));
  s->step(updates);
  const double found = -std::log(projected(c, *s, wave) / start) / (k * k * updates * step);
  CAPTURE(step, nu, pbf::viscous_sweeps(c.scene).sweeps);
  CHECK(found == Approx(nu).epsilon(0.02));  // 1 - (kd)^2/12 and so on
}

TEST_CASE("one update at an adaptive level acts like two with half the step") {
  const double k = 2 * M_PI / (16 * kSpacing);
  const auto wave = [&](double z) { return 0.1 * std::sin(k * z); };
  Case c = layers(8, 16, wave);
  c.scene.domain.periodic = {"x", "z"};
  c.scene.time.adaptive = pbf::AdaptiveTime{};
  c.scene.time.order = TimeOrder::first;
  give_viscosity(c, 2e-3);
  auto coarse = make(c), fine = make(c);
  coarse->step(20);
  fine->step(20, {.level = 2});
  CHECK(projected(c, *fine, wave) == Approx(projected(c, *coarse, wave)).epsilon(0.01));
  CHECK(projected(c, *fine, wave) < 0.9);
}

TEST_CASE("without slip a plate that moves draws a linear profile: Couette's flow") {
  const int nz = 12;
  const double speed = 0.1, height = nz * kSpacing;
  Case c = layers(8, nz, [](double) { return 0; });
  c.scene.domain.max[2] += 3 * kSpacing;
  c.scene.domain.friction = 1;
  c.scene.domain.friction_on = {"z_min"};
  c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
  c.scene.solver.substeps = GENERATE(1, 2);
  pbf::Obstacle& plate = c.scene.obstacles.emplace_back();
  plate.name = "plate";
  plate.shape = pbf::obstacle_keys::Plane{{0.05, 0.5 * kSpacing, height}, {0, 0, -1}};
  plate.friction = 1;
  plate.loads = true;
  plate.motion.emplace();
  plate.motion->kind = pbf::MotionKind::velocity;
  plate.motion->velocity = {speed, 0, 0};
  const double nu = 4e-3;
  give_viscosity(c, nu);
  auto s = make(c);
  s->step(900);
  s->readings(Series::measures, Interval::ends);
  CHECK(farthest_from(c, *s, [&](double z) { return speed * z / height; }) < 0.03 * speed);
  // The force on the plate is that of the shear, and is passed on to the floor.
  s->step(20);
  const auto loads = loads_of(c, *s);
  REQUIRE(loads.size() == 1);
  const double area = 8 * kSpacing * kSpacing;
  CHECK(loads[0].force[0] == Approx(-1000 * nu * speed / height * area).epsilon(0.03));
}

TEST_CASE("gravity along a periodic axis drives Poiseuille's flow between walls without slip") {
  const int nz = 12;
  const double height = nz * kSpacing, nu = 4e-3, g = 0.05;
  const auto profile = [&](double z) { return 0.5 * g / nu * z * (height - z); };
  Case c = layers(8, nz, profile);
  c.scene.domain.friction = 1;
  c.scene.domain.loads = true;
  c.scene.gravity = {g, 0, 0};
  c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
  give_viscosity(c, nu);
  auto s = make(c);
  s->step(400);
  CHECK(projected(c, *s, profile) == Approx(1).epsilon(0.08));
  CHECK(farthest_from(c, *s, profile) < 0.08 * profile(0.5 * height));
  s->readings(Series::measures, Interval::ends);
  s->step(20);
  double drag = 0;
  for (const auto& load : loads_of(c, *s)) drag += load.force[0];
  CHECK(drag == Approx(g * c.scene.particle_mass() * double(c.particles.size())).epsilon(0.02));
}

TEST_CASE("a wall takes the share of the slip that the integral over the half space says") {
  const bool flat = GENERATE(true, false);
  const double friction = GENERATE(1.0, 0.3), at = GENERATE(0.1, 0.25, 0.6, 0.9);  // h
  const double h = 2 * kSpacing;
  Case c;
  c.scene.fluid.spacing = kSpacing;
  c.scene.dimensions = flat ? 2 : 3;
  c.scene.domain.min = {0, 0, 0};
  c.scene.domain.max = {0.5, flat ? kSpacing : 0.5, 0.7};
  c.scene.gravity = {0, 0, 0};
  c.scene.time = {1e-5, 1, {}};
  c.scene.time.order = TimeOrder::first;
  c.scene.solver.iterations = 0;
  c.scene.domain.friction = friction;
  c.scene.domain.loads = true;
  c.scene.viscosity = pbf::Viscosity{0.2};
  const bool low = GENERATE(true, false);
  const double y = flat ? 0.5 * kSpacing : 0.25;
  c.particles.position.push_back({0.25, y, low ? at * h : 0.7 - at * h});
  c.particles.velocity.push_back({0.3, flat ? 0 : -0.2, 0.1});
  c = here(c);
  auto s = make(c);
  s->step(1);
  const double share = std::min(1.0, friction * 0.2 * lattice_behind(flat) /
                                         moment_behind(0.25, flat) * moment_behind(at, flat) / at);
  const pbf::Snapshot snap = s->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto v = snap.find("velocity")->as<double>();
  CAPTURE(flat, friction, at, low, share);
  // In the plane the moment is a polynomial within 7e-5.
  CHECK(1 - v[0] / 0.3 ==
        Approx(share).epsilon(flat ? 0.01 : 1e-3).margin(is_double() ? 1e-4 : 2e-4));
  if (!flat) CHECK(v[1] / v[0] == Approx(-2.0 / 3));
  CHECK(v[2] == Approx(0.1));  // what is along the normal stays
  const auto loads = loads_of(c, *s);
  const auto& wall = *std::find_if(loads.begin(), loads.end(), [&](const auto& l) {
    return l.wall == (low ? "z_min" : "z_max");
  });
  CHECK(wall.force[0] * 1e-5 ==
        Approx(c.scene.particle_mass() * (0.3 - v[0])).epsilon(1e-3).margin(1e-9));
}

TEST_CASE("a ball that turns takes the fluid along, by the torque that it feels, at its work") {
  Case c = jittered_block(10, 10, 10, 0.05, 0);
  c.scene.gravity = {0, 0, 0};
  c.scene.time.order = GENERATE(TimeOrder::first, TimeOrder::second);
  const double d = c.scene.fluid.spacing;
  const Double3 middle{c.scene.domain.min[0] + 5 * d, c.scene.domain.min[1] + 5 * d,
                       c.scene.domain.min[2] + 5 * d};
  c.scene.domain.open = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  std::erase_if(c.particles.position, [&](const Double3& x) {
    return std::hypot(x[0] - middle[0], x[1] - middle[1], x[2] - middle[2]) < 3 * d;
  });
  c.particles.velocity.assign(c.particles.position.size(), {0, 0, 0});
  pbf::Obstacle& ball = c.scene.obstacles.emplace_back();
  ball.name = "ball";
  ball.shape = pbf::obstacle_keys::Sphere{middle, 2.5 * d};
  ball.friction = 1;
  ball.motion.emplace();
  ball.motion->kind = pbf::MotionKind::velocity;
  ball.motion->angular = {0, 360, 0};
  ball.loads = true;
  give_viscosity(c, 0.02);
  c = here(c);
  auto s = make(c);
  const double before = s->diagnose().kinetic_energy;
  s->step(40);
  const pbf::Snapshot snap = s->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), v = snap.find("velocity")->as<double>();
  double turning = 0;
  for (std::size_t i = 0; i < x.size(); i += 3)
    turning += (x[i + 2] - middle[2]) * v[i] - (x[i] - middle[0]) * v[i + 2];
  turning *= c.scene.particle_mass();
  const auto loads = loads_of(c, *s);
  REQUIRE(loads.size() == 1);
  CHECK(turning > 0);
  CHECK(before == 0);
  CHECK(loads[0].torque[1] < 0);
  // What the ball gave went into the fluid, less what the rim loses (kernels/README.md).
  CHECK(-loads[0].torque[1] * 40 * c.scene.time.step == Approx(turning).epsilon(0.3));
}
