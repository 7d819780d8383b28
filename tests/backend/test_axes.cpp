// The axes that a solver works in are its own affair: whatever goes in and comes out is in the
// axes of the scene.
#include <algorithm>
#include <array>
#include <cmath>

#include "lib/run/guard.h"
#include "tests/support/backend.h"
#include "tests/support/catch.h"
#include "tests/support/guard_check.h"

using namespace oracle_test;
using backend_test::here;
using backend_test::is_double;

namespace {

/// Axis k of a turned scene is axis turn[k] of the first one.
using Turn = std::array<std::size_t, 3>;
const std::vector<Turn> kTurns{{1, 0, 2}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}};

template <class Vector>
Vector turned(const Vector& v, const Turn& t) {
  return {v[t[0]], v[t[1]], v[t[2]]};
}

Case turned(const Case& c, const Turn& t) {
  Case out = c;
  out.scene.domain.min = turned(c.scene.domain.min, t);
  out.scene.domain.max = turned(c.scene.domain.max, t);
  out.scene.gravity = turned(c.scene.gravity, t);
  for (std::string& face : out.scene.domain.open)
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] == std::size_t(face[0] - 'x')) {
        face[0] = char('x' + k);
        break;
      }
  for (auto& x : out.particles.position) x = turned(x, t);
  for (auto& v : out.particles.velocity) v = turned(v, t);
  return out;
}

/// Every feature, no two edges of the box alike, gravity askew, an open face, coincident pairs.
Case everything(bool flat) {
  Case c = here(flat ? flat_block(23, 11, 0.3, 0.6) : jittered_block(9, 7, 13, 0.3, 0.6));
  c.scene.domain.max[0] += 0.15;
  c.scene.gravity = {1, flat ? 0.0 : -2, -9};
  c.scene.domain.open = {"x_max"};
  c.scene.tensile = pbf::Tensile{};
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.vorticity = pbf::Vorticity{5};
  c.particles.position[30] = c.particles.position[31];
  c.particles.velocity[40] = {9, 0, 1};
  return c;
}

/// Rows of three, turned.
template <class T>
std::vector<T> rows(const T* from, std::size_t n, const Turn& t) {
  std::vector<T> out;
  for (std::size_t i = 0; i < n; i += 3)
    for (std::size_t k = 0; k < 3; ++k) out.push_back(from[i + t[k]]);
  return out;
}
std::vector<double> rows(const std::vector<double>& v, const Turn& t) {
  return rows(v.data(), v.size(), t);
}

void check_same_fields(const pbf::Snapshot& a, const pbf::Snapshot& b, const Turn& t) {
  for (const char* name : {"position", "velocity"}) {
    const auto x = a.find(name)->as<double>(), y = b.find(name)->as<double>();
    CHECK(rows(x.data(), x.size(), t) == std::vector<double>(y.begin(), y.end()));
  }
  CHECK(a.find("density")->bytes == b.find("density")->bytes);
}

void check_same_measures(const pbf::Diagnostics& a, const pbf::Diagnostics& b, const Turn& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(a.momentum[t[k]] == b.momentum[k]);
    CHECK(a.center_of_mass[t[k]] == b.center_of_mass[k]);
    CHECK(a.front[t[k]] == b.front[k]);
  }
  CHECK(a.kinetic_energy == b.kinetic_energy);
  CHECK(a.potential_energy == b.potential_energy);
  CHECK(a.energy == b.energy);
  CHECK(a.compression_mean == b.compression_mean);
  CHECK(a.compression_rms == b.compression_rms);
  CHECK(a.compression_p99 == b.compression_p99);
  CHECK(a.penetration == b.penetration);
  CHECK(a.speed_max == b.speed_max);
  CHECK(a.outside == b.outside);
  CHECK(a.neighbors_mean == b.neighbors_mean);
}

}  // namespace

TEST_CASE("a scene with its axes exchanged gives the same bits, exchanged back") {
  const bool flat = GENERATE(false, true);
  const Case c = everything(flat);
  auto first = make(c);
  first->step(20);
  const std::vector<std::string> fields{"velocity", "density"};
  const pbf::Snapshot snap = first->download(fields, pbf::ScalarType::f64).get();
  const pbf::Diagnostics measures = first->diagnose();
  const pbf::SolverState state = first->state();
  const pbf::StepTrace trace = first->inspection()->trace();
  for (const Turn& t : kTurns) {
    if (flat && t != Turn{2, 1, 0}) continue;
    CAPTURE(flat, t[0], t[1], t[2]);
    const Case other = turned(c, t);
    auto s = make(other);
    s->step(20);
    check_same_fields(snap, s->download(fields, pbf::ScalarType::f64).get(), t);
    check_same_measures(measures, s->diagnose(), t);
    const pbf::SolverState mine = s->state();
    CHECK(rows(state.position, t) == mine.position);
    CHECK(rows(state.velocity, t) == mine.velocity);
    CHECK(state.id == mine.id);
    const pbf::StepTrace passes = s->inspection()->trace();
    REQUIRE(passes.arrays.size() == trace.arrays.size());
    const bool mirrored = t != Turn{1, 2, 0} && t != Turn{2, 0, 1};
    for (std::size_t k = 0; k < passes.arrays.size(); ++k) {
      const pbf::TraceArray &a = trace.arrays[k], &b = passes.arrays[k];
      CAPTURE(a.stage, a.quantity);
      std::vector<double> expected = a.components == 3 ? rows(a.values, t) : a.values;
      if (mirrored && a.quantity == "curl times its gain")
        for (double& x : expected) x = -x;
      CHECK(b.values == expected);
    }
    CHECK(passes.neighbors == trace.neighbors);
    // And on from there: a state of one scene, turned, is one of the other.
    pbf::SolverState in = state;
    in.position = rows(state.position, t);
    in.velocity = rows(state.velocity, t);
    for (pbf::StoredField& f : in.fields)
      if (f.name == "free velocity") f.values = rows(f.values, t);
    s->set_state(in);
    auto again = make(c);
    again->set_state(state);
    again->step(7);
    s->step(7);
    check_same_fields(again->download(fields, pbf::ScalarType::f64).get(),
                      s->download(fields, pbf::ScalarType::f64).get(), t);
  }
}

TEST_CASE("an update in a box with any longest edge is that of brute force") {
  Case c = here(jittered_block(5, 4, 6, 0.3, 0.5));
  c.scene.gravity = {1, -2, -9};
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.vorticity = pbf::Vorticity{5};
  const std::size_t longest = GENERATE(0u, 1u, 2u);
  c.scene.domain.max[longest] += 0.3;
  const Difference d = against_oracle(c);
  CHECK(d.position < (is_double() ? 1e-12 : 1e-4));
  CHECK(d.velocity < (is_double() ? 3e-12 : 1e-4));
}

TEST_CASE("a thrown particle is where a hand calculation puts it, in any box, in every output") {
  const std::size_t longest = GENERATE(0u, 1u, 2u);
  Case c = here(jittered_block(1, 1, 1, 0, 0));
  c.scene.time.order = pbf::TimeOrder::first;
  c.scene.domain.min = {1, 2, 3};
  c.scene.domain.max = {2, 3.25, 4.5};
  c.scene.domain.max[longest] += 1;
  c.scene.gravity = {0.5, -1, 2};
  c.particles.position = {{1.5, 2.5, 3.5}};
  c.particles.velocity = {{1, -0.5, 0.25}};
  const double rounding = is_double() ? 1e-12 : 1e-5, dt = c.scene.time.step, mass = 8e-3, h = 0.04;
  const int n = 50;
  double x[3], v[3];
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = c.particles.velocity[0][k] + n * dt * c.scene.gravity[k];
    x[k] = c.particles.position[0][k] + n * dt * c.particles.velocity[0][k] +
           dt * dt * n * (n + 1) / 2 * c.scene.gravity[k];
  }
  auto s = make(c);
  s->step(n);
  const pbf::Snapshot snap = s->download({"velocity"}, pbf::ScalarType::f64).get();
  const pbf::Diagnostics m = s->diagnose();
  const pbf::SolverState state = s->state();
  double potential = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(snap.fields[0].as<double>()[k] == Approx(x[k]).epsilon(rounding));
    CHECK(snap.find("velocity")->as<double>()[k] == Approx(v[k]).epsilon(rounding));
    CHECK(m.front[k] == Approx(x[k]).epsilon(rounding));
    CHECK(m.center_of_mass[k] == Approx(x[k]).epsilon(rounding));
    CHECK(m.momentum[k] == Approx(mass * v[k]).epsilon(rounding));
    CHECK(state.position[k] == Approx((x[k] - c.scene.domain.min[k]) / h).epsilon(rounding));
    CHECK(state.velocity[k] == Approx(v[k] / h).epsilon(rounding));
    potential -= mass * c.scene.gravity[k] * (x[k] - c.scene.domain.min[k]);
  }
  CHECK(m.potential_energy == Approx(potential).epsilon(10 * rounding));

  // The guard says where a particle is that a fault makes too fast along x.
  const pbf::Plan plan = pbf::make_plan(c.scene, 1);
  auto faulty = make(c);
  const pbf::Diagnostics first = faulty->diagnose();
  pbf::Guard guard(c.scene, plan, *faulty, first, first);
  faulty->inspection()->inject({1, "predict", 0, 0, 1e6});
  faulty->step(1, guard.options());
  const auto e = check(guard, faulty->diagnose());
  REQUIRE(e);
  CHECK(e->velocity[0] == Approx(1e6 * h).epsilon(1e-6));
  for (std::size_t k = 1; k < 3; ++k)
    CHECK(e->velocity[k] ==
          Approx(c.particles.velocity[0][k] + dt * c.scene.gravity[k]).epsilon(1e-5));
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(e->position[k] == Approx(c.particles.position[0][k] + dt * c.particles.velocity[0][k] +
                                   dt * dt * c.scene.gravity[k])
                                .epsilon(1e-5));
  const pbf::Particles kept = pbf::to_particles(e->last_good, c.scene);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(kept.position[0][k] == Approx(c.particles.position[0][k]).epsilon(1e-6));
    CHECK(kept.velocity[0][k] == Approx(c.particles.velocity[0][k]).epsilon(1e-6));
  }
}

TEST_CASE("a face is open or a wall by its name, in any box") {
  const std::size_t longest = GENERATE(0u, 1u, 2u), face = GENERATE(0u, 1u, 2u, 3u, 4u, 5u);
  const char* names[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  const std::size_t axis = face / 2;
  Case c = here(jittered_block(1, 1, 1, 0, 0));
  c.scene.domain = {{0, 0, 0}, {1, 1, 1}, {names[face]}};
  c.scene.domain.max[longest] = 2;
  c.scene.gravity = {0, 0, 0};
  const double speed = face % 2 ? 100 : -100;
  c.particles.position = {{0.5, 0.5, 0.5}, {0.4, 0.4, 0.4}};
  c.particles.velocity = {{0, 0, 0}, {0, 0, 0}};
  c.particles.velocity[0][axis] = speed;   // leaves
  c.particles.velocity[1][axis] = -speed;  // meets the wall on the other side
  auto s = make(c);
  s->step(20);
  const pbf::Snapshot snap = s->download({}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>();
  CHECK(x[axis] == Approx(0.5 + speed * 20 * c.scene.time.step));
  CHECK(x[3 + axis] >= 0);
  CHECK(x[3 + axis] <= c.scene.domain.max[axis]);
  const pbf::Diagnostics m = s->diagnose();
  CHECK(m.outside == 0);
  CHECK(m.front[axis] == Approx(std::max(x[axis], x[3 + axis])));
}
