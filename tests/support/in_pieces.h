// A run that is stopped again and again.
#pragma once

#include <string>

#include "tests/support/catch.h"
#include "tests/support/process.h"

namespace pbf::test {

/// Runs s.yaml into `out`, stopped after `limit` seconds and resumed with longer and longer limits
/// until it is done; it must have been stopped at least once.
inline void run_in_pieces(const Scratch& folder, const std::string& out, double limit,
                          const Args& more = {}) {
  int stops = 0, code = 75;
  for (; code == 75 && stops < 100; limit *= 1.3) {
    Args words{"--resume", "--max-walltime", std::to_string(limit)};
    words.insert(words.end(), more.begin(), more.end());
    code = run_scene(folder, out, words).code;
    REQUIRE((code == 75 || code == 0));
    stops += code == 75;
  }
  CHECK(stops >= 1);
  REQUIRE(code == 0);
}

}  // namespace pbf::test
