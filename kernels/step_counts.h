// Counters of a run.
#pragma once

#include "kernels/atomics.h"

namespace pbf {

struct StepCounts {
  unsigned long long fast = 0;     ///< particle-updates above the watched speed (Params)
  unsigned long long repeats = 0;  ///< repeats of the iterations beyond the first of every substep
  unsigned long long unresolved = 0;  ///< particles times steps (relative_motion.h)
  float way_squared = 0;              ///< h^2, largest squared motion relative to a neighbor

  /// Calls f for every number, in the order of files.
  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    f(s.fast), f(s.repeats), f(s.unresolved), f(s.way_squared);
  }
};

}  // namespace pbf
