// What the tests of tests/backend run on.
#pragma once

#include "tests/support/against_oracle.h"
#include "tests/support/catch.h"

namespace backend_test {

/// Set by main() from `--on BACKEND:PRECISION`.
inline pbf::Backend& backend() {
  static pbf::Backend b = pbf::Backend::cpu;
  return b;
}
inline pbf::Precision& precision() {
  static pbf::Precision p = pbf::Precision::single;
  return p;
}
inline bool is_double() { return precision() == pbf::Precision::dbl; }

/// The case on the backend and precision under test.
inline oracle_test::Case here(oracle_test::Case c) {
  c.scene.backend = backend();
  c.scene.precision = precision();
  c.scene.threads = 2;
  return c;
}

/// A case without particles so far, in which nothing acts on them; `step` in s.
inline oracle_test::Case drifting(double step, pbf::TimeOrder order) {
  oracle_test::Case c = here({});
  c.scene.fluid.spacing = 0.05;
  c.scene.gravity = {0, 0, 0};
  c.scene.time = {step, 1, {}};
  c.scene.time.order = order;
  c.scene.solver.iterations = 0;
  c.scene.solver.prestabilize = false;
  return c;
}

/// Particles alone: the same after other updates too.
inline bool same_particles(const pbf::SolverState& a, const pbf::SolverState& b) {
  return a.position == b.position && a.velocity == b.velocity && a.id == b.id;
}

/// A block of fluid that falls, with some particles in one place and some that pass others fast.
inline oracle_test::Case falling_block(int edge) {
  oracle_test::Case c = here(oracle_test::jittered_block(edge, edge, edge, 0.3, 0.5));
  auto& p = c.particles;
  const std::size_t n = p.position.size();
  p.position[n / 2] = p.position[n / 2 + 1];
  p.position[n - 1] = p.position[n - 2] = p.position[n - 3];
  p.velocity[n / 3] = {12, 0, -3};
  c.scene.viscosity = pbf::Viscosity{};
  c.scene.viscosity->xsph = 0.05;
  c.scene.tensile = pbf::Tensile{};
  c.scene.solver.prestabilize = false;
  return c;
}

/// What updates leave, recorded or one by one.
struct Ending {
  pbf::SolverState state;
  double compression = 0, launches = 0;
  std::int64_t neighbors = 0;
};
inline Ending ending_of(pbf::Solver& solver, bool one_by_one, int updates) {
  if (one_by_one)
    for (int k = 0; k < updates; ++k) solver.inspection()->trace();
  else
    solver.step(updates);
  const pbf::Diagnostics m = solver.diagnose();
  return {solver.state(), m.compression_mean, solver.info().launches, m.neighbors_max};
}
inline void check_same(const Ending& a, const Ending& b) {
  CHECK(same_particles(a.state, b.state));
  CHECK(a.state.fields == b.state.fields);  // also free velocities, and what viscosity took
  CHECK(a.compression == b.compression);
  CHECK(a.neighbors == b.neighbors);
}

using pbf::Series;

/// The readings of the loads of a wall or an obstacle, SI units.
struct WallLoad {
  std::string wall;
  double force[3], torque[3], peak, impulse[3];
};
inline std::vector<WallLoad> loads_of(const oracle_test::Case& c, pbf::Solver& solver,
                                      pbf::Interval interval = pbf::Interval::goes_on) {
  const std::vector<double> r = solver.readings(Series::measures, interval);
  std::vector<WallLoad> loads;
  std::size_t k = 0;
  for (const auto& column : pbf::make_plan(c.scene, std::int64_t(c.particles.size())).columns)
    if (column.name == std::string("force")) {
      loads.push_back({column.of,
                       {r.at(k), r.at(k + 1), r.at(k + 2)},
                       {r.at(k + 3), r.at(k + 4), r.at(k + 5)},
                       r.at(k + 6),
                       {r.at(k + 7), r.at(k + 8), r.at(k + 9)}});
      k += 10;
    } else if (column.kind == std::string("dissipation")) {
      ++k;
    }
  REQUIRE(k == r.size());
  return loads;
}

/// The loads of the solver so far are `expected`, to the last bit.
inline void check_loads(pbf::Solver& solver, const std::vector<double>& expected) {
  CHECK_FALSE(expected.empty());
  CHECK(solver.readings(Series::measures, pbf::Interval::goes_on) == expected);
}

inline bool same_bytes(const pbf::Snapshot& a, const pbf::Snapshot& b) {
  if (a.fields.size() != b.fields.size()) return false;
  for (std::size_t f = 0; f < a.fields.size(); ++f)
    if (a.fields[f].bytes != b.fields[f].bytes) return false;
  return true;
}

}  // namespace backend_test
