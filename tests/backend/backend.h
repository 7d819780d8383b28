// What the tests of this folder run on.
#pragma once

#include "tests/oracle/compare.h"

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

}  // namespace backend_test
