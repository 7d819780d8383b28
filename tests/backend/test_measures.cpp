// The measures of states with known answers, on every backend and precision.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;

namespace {

/// Diagnostics by the definitions of lib/solver/DIAGNOSTICS.md, from brute-force densities.
struct Expected {
  double mean = 0, rms = 0, p99 = 0, max = 0, above_1 = 0, above_10 = 0;
};
Expected expected(const Case& c) {
  std::vector<oracle::V> x;
  for (const auto& p : c.particles.position) x.push_back({p[0], p[1], p[2]});
  std::vector<double> compression;
  for (const auto rho : oracle::densities(x, settings_of(c)))
    compression.push_back(std::max(double(rho / 1000) - 1, 0.0));
  std::sort(compression.begin(), compression.end());
  const double n = double(compression.size());
  Expected e;
  for (const double v : compression) {
    e.mean += v / n;
    e.rms += v * v / n;
    e.above_1 += v > 0.01 ? 1 / n : 0;
    e.above_10 += v > 0.1 ? 1 / n : 0;
  }
  e.rms = std::sqrt(e.rms);
  e.max = compression.back();
  e.p99 = compression[std::size_t(std::ceil(0.99 * n)) - 1];  // 99 % are at or below it
  return e;
}

void check_compression(const Case& c) {
  const Expected e = expected(c);
  const pbf::Diagnostics m = make(c)->diagnose();
  const double tolerance = is_double() ? 1e-10 : 3e-6;
  CHECK(m.compression_mean == Approx(e.mean).margin(tolerance));
  CHECK(m.compression_rms == Approx(e.rms).margin(tolerance));
  CHECK(m.compression_max == Approx(e.max).margin(tolerance));
  CHECK(m.compression_p99 >= e.p99 - tolerance);
  CHECK(m.compression_p99 <= e.p99 * (1 + 1.0 / 32) + tolerance);
  // A particle within rounding of the limit may count on either side.
  const double one = is_double() ? 1e-12 : 1.5 / double(c.particles.size());
  CHECK(m.share_above_1 == Approx(e.above_1).margin(one));
  CHECK(m.share_above_10 == Approx(e.above_10).margin(one));
}

/// A lattice of spacing `scale` d in the middle of a box three smoothing lengths away.
Case free_lattice(int n, double scale) {
  Case c = here(jittered_block(n, n, n, 0, 0, 1, scale));
  for (std::size_t k = 0; k < 3; ++k) {
    c.scene.domain.min[k] -= 0.12;
    c.scene.domain.max[k] += 0.12;
  }
  return c;
}

/// A pool at rest that fills the floor of its box from wall to wall, gravity along -z.
Case pool(int layers) {
  Case c = here(jittered_block(6, 5, layers, 0, 0));
  c.scene.domain.max[0] = c.scene.domain.min[0] + 6 * c.scene.fluid.spacing;
  return c;
}

/// The hydrostatic deviation from its definition: each particle a slab of thickness d.
double deviation(const Case& c, double depth) {
  double squares = 0;
  for (int k = 1; k <= 8; ++k) {
    double below = 0;
    for (const auto& p : c.particles.position) {
      const double z = (p[2] - c.scene.domain.min[2]) / c.scene.fluid.spacing;
      const double level = k / 8.0 * depth / c.scene.fluid.spacing;
      below += std::min(std::max(level - (z - 0.5), 0.0), 1.0);
    }
    const double e = k / 8.0 - below / double(c.particles.size());
    squares += e * e / 8;
  }
  return std::sqrt(squares);
}

}  // namespace

TEST_CASE("a lattice is not compressed, neither free nor between walls away from edges") {
  const pbf::Diagnostics free = make(free_lattice(12, 1))->diagnose();
  const double rounding = is_double() ? 1e-13 : 1e-6;
  CHECK(free.compression_max < rounding);
  CHECK(free.compression_p99 < rounding);
  CHECK(free.share_above_1 == 0);
  CHECK(free.penetration == 0);
  check_compression(pool(12));
}

TEST_CASE("a lattice compressed by 1 % in volume reads 0.774 %, the sum over its kernel") {
  const double scale = std::cbrt(1 / 1.01);
  const Case c = free_lattice(14, scale);
  // Of the 1 % the particle's own share of the sum, W(0), feels nothing.
  const auto sum = [](double spacing) {
    double all = 0;
    for (int z = -2; z <= 2; ++z)
      for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
          all += std::pow(std::max(1 - spacing / 2 * std::sqrt(x * x + y * y + z * z), 0.0), 3);
    return all;
  };
  const double inside = sum(scale) / sum(1) - 1;
  CHECK(inside == Approx(0.00774).epsilon(1e-3));
  CHECK(make(c)->diagnose().compression_max == Approx(inside).epsilon(is_double() ? 1e-9 : 1e-3));
  check_compression(c);
}

TEST_CASE("one displaced particle compresses its neighbors as brute force says, and no other") {
  Case c = free_lattice(12, 1);
  c.particles.position[5 * 144 + 5 * 12 + 5][0] += 0.4 * c.scene.fluid.spacing;
  check_compression(c);
  const pbf::Diagnostics m = make(c)->diagnose();
  CHECK(m.compression_max > 0.01);
  CHECK(m.share_above_1 * 1728 < 34);
  CHECK(m.compression_p99 < m.compression_max);
}

TEST_CASE("percentile and shares of a random state are those of its sorted densities") {
  check_compression(here(jittered_block(11, 9, 13, 0.45, 0)));
  check_compression(here(jittered_block(8, 8, 8, 0.3, 0, 7, 0.6)));
}

TEST_CASE("a pool at rest keeps its height and its hydrostatic profile, a sunken one does not") {
  const double rounding = is_double() ? 1e-12 : 1e-6;
  for (const int layers : {9, 16, 40}) {
    Case c = pool(layers);
    const pbf::Diagnostics m = make(c)->diagnose();
    CHECK(m.height_kept == Approx(1).margin(rounding));
    CHECK(m.hydrostatic_deviation < rounding);
    const double depth = layers * c.scene.fluid.spacing, low = c.scene.domain.min[2];
    for (auto& p : c.particles.position) p[2] = low + 0.9 * (p[2] - low);
    const pbf::Diagnostics sunken = make(c)->diagnose();
    CHECK(sunken.height_kept == Approx(0.9).margin(rounding));
    CHECK(sunken.hydrostatic_deviation == Approx(deviation(c, depth)).margin(10 * rounding));
    CHECK(sunken.hydrostatic_deviation > 0.04);
  }
}

TEST_CASE("the pool may rest on any wall that gravity points at, and must have one") {
  Case c = pool(12);
  const pbf::Diagnostics down = make(c)->diagnose();
  // Upside down: mirrored in z, gravity up.
  Case up = c;
  for (auto& p : up.particles.position) p[2] = c.scene.domain.min[2] + c.scene.domain.max[2] - p[2];
  up.scene.gravity = {0, 0, 9.81};
  const pbf::Diagnostics mirrored = make(up)->diagnose();
  CHECK(mirrored.height_kept == Approx(1).margin(2e-6));
  CHECK(mirrored.hydrostatic_deviation < 2e-6);
  CHECK(mirrored.energy == Approx(down.energy).epsilon(1e-5));
  const auto undefined = [](const Case& with) {
    const pbf::Diagnostics m = make(with)->diagnose();
    return std::isnan(m.height_kept) && std::isnan(m.hydrostatic_deviation);
  };
  Case other = c;
  other.scene.gravity = {1, 0, -9.81};
  CHECK(undefined(other));
  other.scene.gravity = {0, 0, 0};
  CHECK(undefined(other));
  other = c;
  other.scene.domain.open = {"z_min"};
  CHECK(undefined(other));
  other.scene.domain.open = {"x_max"};
  CHECK(undefined(other));
  other.scene.domain.open = {"z_max"};
  CHECK_FALSE(undefined(other));
}

TEST_CASE("the energy is M g z + K above the lowest corner of the box") {
  Case c = here(jittered_block(6, 5, 7, 0.2, 0.5));
  double expected_energy = 0;
  const double mass = 1000 * std::pow(c.scene.fluid.spacing, 3);
  c.scene.gravity = {2, 0, -9.81};
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const auto &x = c.particles.position[i], &v = c.particles.velocity[i];
    expected_energy +=
        mass * (9.81 * (x[2] - c.scene.domain.min[2]) + 2 * (c.scene.domain.max[0] - x[0]) +
                0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  CHECK(make(c)->diagnose().energy == Approx(expected_energy).epsilon(is_double() ? 1e-12 : 1e-5));
}

TEST_CASE("penetration is the distance behind the clamp, whichever wall it is") {
  Case c = free_lattice(4, 1);
  const double d = c.scene.fluid.spacing;
  const std::size_t axis = GENERATE(0u, 1u, 2u);
  SECTION("behind the lower wall") {
    c.particles.position[7][axis] = c.scene.domain.min[axis] - 0.3 * d;
  }
  SECTION("behind the upper wall") {
    c.particles.position[7][axis] = c.scene.domain.max[axis] + 0.3 * d;
  }
  CHECK(make(c)->diagnose().penetration == Approx(0.3 * d).epsilon(1e-4));
  c.scene.solver.wall_margin = 0.2 * d;
  CHECK(make(c)->diagnose().penetration == Approx(0.5 * d).epsilon(1e-4));
  CHECK(make(c)->diagnose().outside == 1);
  c.scene.domain.open = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  CHECK(make(c)->diagnose().penetration == 0);
}

TEST_CASE(
    "without iterations, viscosity and vorticity particles fall freely, measured often or never") {
  Case c = free_lattice(9, 0.9);
  c.scene.time.order = pbf::TimeOrder::first;
  c.scene.solver.iterations = 0;
  c.scene.solver.substeps = GENERATE(1, 2);
  c.scene.time.step = 0.001;
  auto often = make(c), never = make(c), moved = make(c);
  const int updates = 100;
  for (int k = 0; k < updates; k += 4) {
    often->step(4);
    often->diagnose();
    often->download({"density"}, pbf::ScalarType::f64).get();
  }
  never->step(updates);
  const auto fields = std::vector<std::string>{"velocity", "density"};
  const auto x = often->download(fields, pbf::ScalarType::f64).get();
  const auto y = never->download(fields, pbf::ScalarType::f64).get();
  for (const char* name : {"position", "velocity", "density"})
    CHECK(x.find(name)->bytes == y.find(name)->bytes);
  // Symplectic Euler: n steps of dt fall by g dt^2 n (n + 1)/2.
  const int n = updates * c.scene.solver.substeps;
  const double dt = c.scene.time.step / c.scene.solver.substeps;
  const double fall = 9.81 * dt * dt * n * (n + 1) / 2;
  const auto p = x.find("position")->as<double>();
  double worst = 0;
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const auto& start = c.particles.position[i];
    worst = std::max(worst, std::fabs(p[3 * i + 2] - (start[2] - fall)));
    worst = std::max(worst, std::fabs(p[3 * i] - start[0]));
  }
  CHECK(worst < (is_double() ? 1e-12 : 5e-6));
  // The lattice has only moved: its density is what it was, and so are measures from new lists.
  const pbf::Diagnostics m = often->diagnose();
  CHECK(m.compression_mean == Approx(moved->diagnose().compression_mean).margin(1e-5));
  CHECK(never->diagnose().compression_mean == m.compression_mean);
}

TEST_CASE("measures of positions and velocities have the same bits in any order of rows") {
  Case c = here(jittered_block(13, 11, 17, 0.3, 2));
  c.scene.threads = GENERATE(1, 3);
  auto a = make(c), b = make(c);
  a->step(3);
  const pbf::SolverState s = a->state();
  std::vector<std::size_t> order(s.id.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(4));
  pbf::SolverState shuffled = s;
  for (std::size_t k = 0; k < order.size(); ++k) {
    shuffled.id[k] = s.id[order[k]];
    for (std::size_t i = 0; i < 3; ++i) {
      shuffled.position[3 * k + i] = s.position[3 * order[k] + i];
      shuffled.velocity[3 * k + i] = s.velocity[3 * order[k] + i];
    }
  }
  a->set_state(s);
  b->set_state(shuffled);
  const pbf::Diagnostics x = a->diagnose(), y = b->diagnose();
  for (int k = 0; k < 3; ++k) {
    CHECK(x.momentum[k] == y.momentum[k]);
    CHECK(x.center_of_mass[k] == y.center_of_mass[k]);
    CHECK(x.front[k] == y.front[k]);
  }
  CHECK(x.kinetic_energy == y.kinetic_energy);
  CHECK(x.potential_energy == y.potential_energy);
  CHECK(x.energy == y.energy);
  CHECK(x.speed_max == y.speed_max);
  CHECK(x.height_kept == y.height_kept);
  CHECK(x.hydrostatic_deviation == y.hydrostatic_deviation);
  CHECK(x.neighbors_mean == y.neighbors_mean);
}

TEST_CASE("free fall gains m g t of momentum to rounding, and keeps what is level") {
  Case c = free_lattice(9, 1.2);
  c.scene.solver.iterations = 0;
  c.scene.domain.open = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  for (std::size_t i = 0; i < c.particles.size(); ++i)
    c.particles.velocity[i] = {0.5 * (i % 3 ? 1 : -2), 0.25, -1};
  auto s = make(c);
  const pbf::Diagnostics before = s->diagnose();
  s->step(100);
  const pbf::Diagnostics after = s->diagnose();
  const double mass = 1000 * std::pow(c.scene.fluid.spacing, 3) * double(c.particles.size());
  // Every third of them goes the other way, twice as fast.
  CHECK(std::fabs(after.momentum[0]) < 1e-12 * mass);
  CHECK(after.momentum[1] == before.momentum[1]);
  CHECK(after.momentum[1] == Approx(0.25 * mass).epsilon(is_double() ? 1e-15 : 1e-7));
  CHECK(
      after.momentum[2] - before.momentum[2] ==
      Approx(-9.81 * mass * (after.time - after.velocity_lag)).epsilon(is_double() ? 1e-13 : 1e-5));
}
