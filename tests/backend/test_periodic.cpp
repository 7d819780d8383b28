// Periodic axes: what leaves through one face enters through the other, and pairs are those of the
// nearest images.
#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/smoothing.h"
#include "lib/base/error.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;

namespace {

/// A block that fills the domain along the periodic axes, without forces along them.
Case periodic(Case c, const std::vector<std::string>& axes, std::array<int, 3> cells) {
  c.scene.domain.periodic = axes;
  for (const std::string& axis : axes) {
    const auto k = std::size_t(axis[0] - 'x');
    c.scene.domain.max[k] = c.scene.domain.min[k] + cells[k] * c.scene.fluid.spacing;
    c.scene.gravity[k] = 0;
  }
  return here(c);
}
Case in_space(const std::vector<std::string>& axes, double jitter, double speed) {
  return periodic(jittered_block(7, 6, 8, jitter, speed), axes, {7, 6, 8});
}
Case in_plane(const std::vector<std::string>& axes, double jitter, double speed) {
  return periodic(flat_block(9, 8, jitter, speed), axes, {9, 1, 8});
}

double period(const Case& c, std::size_t axis) {
  for (const std::string& name : c.scene.domain.periodic)
    if (name[0] == char('x' + axis)) return c.scene.domain.max[axis] - c.scene.domain.min[axis];
  return 0;
}
/// The largest distance between two states, h, across faces where that is shorter.
double distance(const Case& c, const pbf::SolverState& a, const pbf::SolverState& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.position.size(); ++k) {
    double d = a.position[k] - b.position[k];
    if (const double length = period(c, k % 3) / c.scene.h(); length > 0)
      d = std::remainder(d, length);
    worst = std::max(worst, std::fabs(d));
  }
  return worst;
}
bool inside(const Case& c, const std::vector<double>& position) {
  for (std::size_t k = 0; k < position.size(); ++k)
    if (const double length = period(c, k % 3) / c.scene.h();
        length > 0 && !(position[k] >= 0 && position[k] < length))
      return false;
  return true;
}

const std::vector<std::vector<std::string>> kAxes{{"x"}, {"z"}, {"x", "z"}, {"x", "y", "z"}};

}  // namespace

TEST_CASE("updates across periodic faces are those of brute force with the nearest images") {
  const bool flat = GENERATE(false, true);
  std::vector<std::string> axes = GENERATE(from_range(kAxes));
  if (flat) std::erase(axes, "y");
  CAPTURE(flat, axes);
  Case c = flat ? in_plane(axes, 0.3, 0.4) : in_space(axes, 0.3, 0.4);
  c.scene.time.order = pbf::TimeOrder::first;
  SECTION("first order") {}
  SECTION("second order") { c.scene.time.order = pbf::TimeOrder::second; }
  SECTION("substeps") { c.scene.solver.substeps = 3; }
  SECTION("artificial pressure, viscosity and vorticity confinement") {
    c.scene.tensile = pbf::Tensile{0.01, 0.25, 4};
    c.scene.viscosity = pbf::Viscosity{0.3};
    c.scene.vorticity = pbf::Vorticity{20};
  }
  SECTION("the paper's kernels") { c.scene.solver.kernels = pbf::KernelMode::paper; }
  const Difference d = against_oracle(c, 2);
  CHECK(d.position < (is_double() ? 3e-12 : 2e-4));
  CHECK(d.velocity < (is_double() ? 6e-12 : 2e-4));
}

TEST_CASE("fluid that comes round through a periodic face meets an obstacle as in brute force") {
  Case c = periodic(jittered_block(14, 6, 5, 0.3, 0.4), {"x"}, {14, 6, 5});
  pbf::Obstacle& o = c.scene.obstacles.emplace_back();
  o.name = "box";
  o.loads = true;
  const auto &low = c.scene.domain.min, &high = c.scene.domain.max;
  const double d = c.scene.fluid.spacing;
  o.shape = pbf::obstacle_keys::Box{{low[0] + 5 * d, low[1], low[2]},
                                    {low[0] + 9 * d, high[1], low[2] + 3 * d}};
  pbf::Particles free;
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const auto& x = c.particles.position[i];
    if (x[0] > low[0] + 4.5 * d && x[0] < low[0] + 9.5 * d && x[2] < low[2] + 3.5 * d) continue;
    free.position.push_back(x);
    free.velocity.push_back(c.particles.velocity[i]);
  }
  c.particles = free;
  const Difference near = against_oracle(c, 2);
  CHECK(near.position < (is_double() ? 1e-8 : 2e-4));  // as in test_obstacles.cpp
  CHECK(near.velocity < (is_double() ? 1e-8 : 2e-4));
  // Later on nothing is inside, and the force is that on a body in the way.
  for (auto& v : c.particles.velocity) v[0] += 1;
  auto solver = make(c);
  solver->step(100);
  CHECK(solver->diagnose().penetration < (is_double() ? 1e-9 : 1e-4) * c.scene.h());
  const auto loads = backend_test::loads_of(c, *solver);
  REQUIRE(loads.size() == 1);
  CHECK(loads[0].force[0] > 0);
}

TEST_CASE("densities near periodic faces are sums over the nearest images") {
  const Case c = in_space({"x", "y"}, 0.3, 0.4);
  auto solver = make(c);
  solver->step(5);
  const pbf::Snapshot snap = solver->download({"density"}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), density = snap.find("density")->as<double>();
  std::vector<oracle::V> places;
  for (std::size_t i = 0; i < x.size(); i += 3) places.push_back({x[i], x[i + 1], x[i + 2]});
  const std::vector<oracle::Real> expected = oracle::densities(places, settings_of(c));
  REQUIRE(expected.size() == density.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(density[i] == Approx(double(expected[i])).epsilon(is_double() ? 1e-12 : 2e-5));
}

TEST_CASE("a lattice that fills a periodic box has one density and stays where it is") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? in_plane({"x", "z"}, 0, 0) : in_space({"x", "y", "z"}, 0, 0);
  c.scene.gravity = {};
  auto solver = make(c);
  const pbf::SolverState start = solver->state();
  solver->step(50);
  const pbf::Snapshot snap = solver->download({"density"}, pbf::ScalarType::f64).get();
  const auto density = snap.find("density")->as<double>();
  const auto [low, high] = std::minmax_element(density.begin(), density.end());
  CHECK(*high / *low == Approx(1).epsilon(is_double() ? 1e-13 : 1e-5));
  CHECK(*high == Approx(1000).epsilon(is_double() ? 1e-9 : 1e-5));
  CHECK(distance(c, solver->state(), start) < (is_double() ? 1e-12 : 1e-4));
}

/// Layers that slide over each other, from one lattice point to the next in 25 updates.
Case shear_wave(bool flat, double speed) {
  Case c = flat ? in_plane({"x", "z"}, 0, 0) : in_space({"x", "y", "z"}, 0, 0);
  c.scene.gravity = {};
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const double z = c.particles.position[i][2] - c.scene.domain.min[2];
    c.particles.velocity[i][0] = speed * std::sin(2 * pbf::kPi * z / period(c, 2));
  }
  return c;
}

/// How far the same scene, moved by whole cells (of 2 spacings) along the periodic axes, has gone
/// another way, h.
double apart_when_moved(const Case& c, int updates) {
  const std::array<int, 3> cells{2, c.scene.domain.periodic.size() > 2 ? 1 : 0, 1};
  Case moved = c;
  for (auto& x : moved.particles.position)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = period(c, k);
      if (length == 0) continue;
      x[k] += cells[k] * c.scene.h();
      if (x[k] >= c.scene.domain.max[k]) x[k] -= length;
    }
  auto a = make(c), b = make(moved);
  a->step(updates);
  b->step(updates);
  pbf::SolverState back = b->state();
  CHECK(inside(c, back.position));
  CHECK(inside(c, a->state().position));
  for (std::size_t k = 0; k < back.position.size(); ++k)
    if (period(c, k % 3) > 0) back.position[k] -= cells[k % 3];
  return distance(c, a->state(), back);
}

TEST_CASE("a periodic scene moved along periodic axes is the same scene, moved") {
  const bool flat = GENERATE(false, true);
  SECTION("a flow without disorder, over 100 updates: a shear wave, and a lattice that flies") {
    Case c = flat ? shear_wave(true, 0.4) : in_space({"x", "y", "z"}, 0, 0);
    if (!flat) {
      c.scene.gravity = {};
      for (auto& v : c.particles.velocity) v = {0.4, -0.1, 0.2};
    }
    c.scene.viscosity = pbf::Viscosity{};
    CHECK(apart_when_moved(c, 100) < (is_double() ? 1e-12 : 1e-2));
  }
  SECTION("disorder, in which rounding grows tenfold in 6 updates, also in closed boxes") {
    std::vector<std::string> axes{"x", "z"};
    if (!flat) axes.push_back("y");
    Case c = flat ? in_plane(axes, 0.2, 0.3) : in_space(axes, 0.2, 0.3);
    c.scene.gravity = {};
    c.scene.viscosity = pbf::Viscosity{};
    CHECK(apart_when_moved(c, 10) < (is_double() ? 1e-11 : 1e-2));
  }
}

TEST_CASE("viscosity damps a shear wave as a sum over the lattice by hand says") {
  const bool flat = GENERATE(false, true);
  // The layers stay where they are, to 2e-3 of the spacing. A cubic lattice is a little denser
  // then.
  Case c = shear_wave(flat, 1e-3);
  const double near = !is_double() ? 2e-2 : flat ? 1e-4 : 1e-3;
  c.scene.time.order = pbf::TimeOrder::first;
  c.scene.viscosity = pbf::Viscosity{0.2};
  // v_i += c sum_j vol W_ij (v_j - v_i), where vol sum_j W_ij = 1 on the lattice at rest, that of
  // the particle itself included. W ~ (2 - r)^3, r in spacings.
  double sum = 0, damped = 0;
  const double k = 2 * pbf::kPi / 8;  // per spacing
  for (int x = -2; x <= 2; ++x)
    for (int y = flat ? 0 : -2; y <= (flat ? 0 : 2); ++y)
      for (int z = -2; z <= 2; ++z) {
        const double w = std::pow(std::max(2 - std::sqrt(double(x * x + y * y + z * z)), 0.0), 3);
        sum += w;
        damped += w * (1 - std::cos(k * z));
      }
  const double factor = 1 - 0.2 * damped / sum;
  auto solver = make(c);
  const int updates = 20;
  solver->step(updates);
  const pbf::SolverState state = solver->state();
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const double before = c.particles.velocity[i][0] / c.scene.h();
    CHECK(state.velocity[3 * i] ==
          Approx(before * std::pow(factor, updates)).margin(near * 1e-3 / c.scene.h()));
  }
  CHECK(std::pow(factor, updates) < 0.9);
}

TEST_CASE("momentum along periodic axes is kept to rounding") {
  Case c = in_space({"x", "y"}, 0.3, 0.5);
  c.scene.viscosity = pbf::Viscosity{0.1};
  for (auto& v : c.particles.velocity) v[0] += 0.3;
  auto solver = make(c);
  const pbf::Diagnostics before = solver->diagnose();
  solver->step(100);
  const pbf::Diagnostics after = solver->diagnose();
  const double mass = c.scene.particle_mass() * double(c.particles.size());
  for (const std::size_t k : {0u, 1u})
    CHECK(std::fabs(after.momentum[k] - before.momentum[k]) / mass < (is_double() ? 1e-13 : 1e-5));
  CHECK(after.kinetic_energy > 0);
  CHECK(before.momentum[0] / mass == Approx(0.3).margin(0.1));
}

TEST_CASE("a particle that crosses periodic faces comes back with its velocity, to the bit") {
  Case c = here(jittered_block(1, 1, 1, 0, 0));
  c.scene.domain = {{0, 0, 0}, {0.5, 0.25, 0.5}, {}, false, {"x", "z"}};
  c.scene.gravity = {};
  c.scene.time.order = pbf::TimeOrder::first;
  c.particles.position = {{0.375, 0.125, 0.125}, {0.0, 0.2, 0.4}};
  c.particles.velocity = {{2, 0, -1}, {0, 0, 100}};  // the second one: 5 h in an update
  auto solver = make(c);
  for (const int updates : {1, 30, 62, 150}) {
    solver->step(updates);
    const pbf::Snapshot s = solver->download({"velocity"}, pbf::ScalarType::f64).get();
    const auto x = s.fields[0].as<double>(), v = s.find("velocity")->as<double>();
    const double time = double(solver->updates()) * c.scene.time.step;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        double at = c.particles.position[i][k] + time * c.particles.velocity[i][k];
        if (k != 1) at -= 0.5 * std::floor(at / 0.5);
        const double off = k == 1 ? x[3 * i + k] - at : std::remainder(x[3 * i + k] - at, 0.5);
        CHECK(std::fabs(off) < (is_double() ? 1e-12 : 1e-4));
        CHECK(x[3 * i + k] >= 0);
        CHECK(x[3 * i + k] < c.scene.domain.max[k]);
      }
    const pbf::SolverState state = solver->state();
    for (std::size_t k = 0; k < 6; ++k) {
      const double v0 = c.particles.velocity[k / 3][k % 3] / c.scene.h();
      CHECK(state.velocity[k] == (is_double() ? v0 : double(float(v0))));
      CHECK(v[k] == Approx(c.particles.velocity[k / 3][k % 3]).epsilon(1e-6));
    }
  }
}

TEST_CASE(
    "periodic scenes have the same bits whether or not states, frames and measures are read") {
  const bool flat = GENERATE(false, true);
  Case c = flat ? in_plane({"x", "z"}, 0.3, 0.9) : in_space({"x", "y"}, 0.3, 0.9);
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.domain.loads = true;
  auto a = make(c), b = make(c), other = make(c);
  const int updates = 40;
  a->step(updates);
  for (int k = 0; k < updates; ++k) {
    b->step(1);
    if (k % 3 == 0) b->diagnose();
    if (k % 4 == 0) b->download({"velocity", "density"}, pbf::ScalarType::f32).get();
    if (k % 5 == 0) b->keep();
    if (k % 7 == 0) {  // resumes in another solver
      other->set_state(b->state());
      b.swap(other);
    }
    if (k % 8 == 0) b->inspection()->trace(), ++k;
  }
  REQUIRE(b->updates() == a->updates());
  const pbf::SolverState x = a->state(), y = b->state();
  CHECK(backend_test::same_particles(x, y));
  CHECK(inside(c, x.position));
  REQUIRE(x.fields.size() == y.fields.size());
  for (std::size_t f = 0; f < x.fields.size(); ++f)
    CHECK((x.fields[f] == y.fields[f] || x.fields[f].name == "loads"));
  CHECK(a->diagnose().compression_mean == b->diagnose().compression_mean);
  b->set_state(b->state(pbf::StateOf::kept));
  CHECK(b->updates() < a->updates());
  b->step(int(a->updates() - b->updates()));
  CHECK(backend_test::same_particles(a->state(), b->state()));
}

TEST_CASE("measures and gauges count every particle of a periodic scene once") {
  Case c = in_space({"x", "y", "z"}, 0, 0);
  c.scene.gravity = {};
  for (auto& v : c.particles.velocity) v = {0.5, 0, 0};
  auto solver = make(c);
  solver->step(30);
  const pbf::Diagnostics m = solver->diagnose();
  const double mass = c.scene.particle_mass() * double(c.particles.size());
  CHECK(m.kinetic_energy == Approx(0.5 * mass * 0.25).epsilon(1e-5));
  CHECK(m.momentum[0] == Approx(0.5 * mass).epsilon(1e-5));
  CHECK(m.outside == 0);
  CHECK(m.non_finite == 0);
  // Within h = 2 d of a point of the lattice, without those at 2 d: 1 + 6 + 12 + 8 + 24 ... by
  // hand.
  int lattice = -1;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      for (int k = -2; k <= 2; ++k) lattice += i * i + j * j + k * k < 4;
  const double at_h = 6;  // at h itself, where rounding decides
  CHECK(m.neighbors_mean >= lattice - 1e-9);
  CHECK(m.neighbors_mean <= lattice + at_h);
}

TEST_CASE("a trace across periodic faces has the pairs of the nearest images, by id") {
  const Case c = in_space({"x", "z"}, 0.3, 0.4);
  auto solver = make(c);
  solver->step(10);
  const pbf::StepTrace trace = solver->inspection()->trace();
  const std::vector<double>* places = nullptr;
  for (const pbf::TraceArray& t : trace.arrays)
    if (t.stage == "grid" && t.quantity == "position") places = &t.values;
  REQUIRE(places);
  const std::size_t n = c.particles.size();
  REQUIRE(places->size() == 3 * n);
  REQUIRE(trace.neighbor_begin.size() == n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::int32_t> expected;
    bool clear = true;  // no pair at h
    for (std::size_t j = 0; j < n; ++j) {
      double d2 = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        double d = (*places)[3 * i + k] - (*places)[3 * j + k];
        if (const double length = period(c, k) / c.scene.h(); length > 0)
          d = std::remainder(d, length);
        d2 += d * d;
      }
      clear = clear && std::fabs(d2 - 1) > 1e-5;
      if (i != j && d2 < 1) expected.push_back(std::int32_t(j));
    }
    if (!clear) continue;
    const std::vector<std::int32_t> found(trace.neighbors.begin() + trace.neighbor_begin[i],
                                          trace.neighbors.begin() + trace.neighbor_begin[i + 1]);
    CHECK(found == expected);
  }
}

TEST_CASE("a check of stages names a fault of a particle at a periodic face, not of its image") {
  const Case c = in_space({"x", "y"}, 0.1, 0.1);
  auto solver = make(c);
  solver->step(3);
  solver->inspection()->inject({solver->updates() + 1, "delta", 2, 0, 1e6});
  const auto event =
      solver->inspection()->step_checked({100 / c.scene.h(), 1e300, 1000}, pbf::StepOptions{});
  REQUIRE(event);
  CHECK(event->id == 0);
  CHECK(event->stage == "delta");
}

TEST_CASE("iterations until a tolerance is met count particles alone") {
  Case c = in_space({"x", "y"}, 0.3, 0.4);
  c.scene.solver.tolerance = 1e-3;
  c.scene.solver.max_iterations = 64;
  auto solver = make(c);
  solver->step(20);
  const pbf::Diagnostics m = solver->diagnose();
  CHECK(m.iterations_done > 20 * c.scene.solver.iterations);
  CHECK(m.compression_mean < 3e-3);
}

TEST_CASE("more images than there is memory for stop a periodic run with their number") {
  Case c = in_space({"x", "y", "z"}, 0, 0);
  c.scene.gravity = {};
  const std::size_t n = c.particles.size();
  for (std::size_t i = 0; i < 3 * n; ++i) {  // four times as many, in a corner
    c.particles.position.push_back(c.scene.domain.min);
    c.particles.velocity.push_back({});
  }
  CHECK_THROWS_WITH(make(c), Catch::Contains("images of particles beyond periodic faces") &&
                                 Catch::Contains("twice as dense"));
}
