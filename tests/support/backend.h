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

/// Particles alone: the same after other updates too.
inline bool same_particles(const pbf::SolverState& a, const pbf::SolverState& b) {
  return a.position == b.position && a.velocity == b.velocity && a.id == b.id;
}

/// The loads of the solver so far are `expected`, to the last bit.
inline void check_loads(pbf::Solver& solver, const std::vector<pbf::WallLoad>& expected) {
  const auto got = solver.loads(pbf::Interval::goes_on);
  REQUIRE(got.size() == expected.size());
  for (std::size_t w = 0; w < got.size(); ++w)
    for (const pbf::LoadNumber& n : pbf::load_numbers())
      CHECK(n.value(got[w]) == n.value(expected[w]));
}

inline bool same_bytes(const pbf::Snapshot& a, const pbf::Snapshot& b) {
  if (a.fields.size() != b.fields.size()) return false;
  for (std::size_t f = 0; f < a.fields.size(); ++f)
    if (a.fields[f].bytes != b.fields[f].bytes) return false;
  return true;
}

}  // namespace backend_test
