// What a feature may have besides passes: memory on the host for one solver, with hooks. Its arrays
// are fields (field.h), so they need no code here.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace pbf::program_module {

/// Steps of length dt (s), `count` of them from step `first` on, counted from the start of the run.
struct StepRange {
  std::int64_t first = 0;
  int count = 0;
  double dt = 0;
};

/// Hooks that do nothing. A feature that needs some has
///   template <class Real> struct Memory : NoMemory
/// with its own version of these functions. c: the StepContext (lib/solver/step_context.h). When a
/// solver is created, all features are called with make(), then all with stand(), then all with
/// forget(); when a state is set with stand() and forget(); otherwise as the hooks say. The order
/// of features is that of their list.
struct NoMemory {
  /// Largest number of steps of one batch.
  template <class S, class P>
  static std::int64_t most_steps(const S&, const P&) {
    return std::numeric_limits<std::int64_t>::max();
  }
  /// Sets the first contents of the feature's fields: c.put(field, rows).
  void make(auto&) {}
  /// The state is now that of `time` (s since the start): at the start, and after a state was set.
  void stand(auto&, double) {}
  /// What follows from earlier steps no longer holds: positions were set or went back, or the
  /// length of steps has changed.
  void forget(auto&) {}
  /// The most particles that these steps may add, for features with `changes_rows`.
  std::int64_t new_rows(auto&, const StepRange&) { return 0; }
  /// Which particle had no row, "" or "...; ": for a feature with `changes_rows`, if one had none.
  std::string no_row_text(auto&) { return ""; }
  /// Tables of the steps to come. Called before each batch, also before a repeated one.
  void before_steps(auto&, const StepRange&) {}
};

}  // namespace pbf::program_module
