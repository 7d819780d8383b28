// The results of every pass of one update. `pbf compare` and its tests use them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/solver/solver_state.h"

namespace pbf::solver_module {

/// A result of a pass, along the scene's axes; row = particle id.
struct TraceArray {
  std::string stage;     ///< name of the pass: predict, grid, lambda, ...
  int iteration = 0;     ///< 1, 2, ... within the iterations, 0 outside them
  std::string quantity;  ///< position, velocity, bin, density, lambda, curl ...
  std::string unit;      ///< of the internal frame
  int components = 1;    ///< scalars per row
  std::vector<double> values;
  /// The same pass already used it for its next array, so replacing it cannot change that array.
  bool used_at_once = false;
};

/// One update, pass by pass. The density is under "density" even if the lambda pass computes it.
struct StepTrace {
  std::vector<TraceArray> arrays;            ///< in the order of the passes
  std::vector<std::int64_t> neighbor_begin;  ///< n + 1: begin of each particle's neighbors
  std::vector<std::int32_t> neighbors;       ///< ids, ascending for each particle
};

/// Options of a trace. With the defaults, the update has the bits of step(1).
struct TraceOptions {
  /// u: all results of passes are rounded at random: value * (1 + r u), r uniform in [-1, 1)
  /// (Parker, Pierce & Eggert 2000, "Monte Carlo arithmetic"). For sums over neighbors, u is
  /// multiplied by 4 + sqrt(terms of the longest sum): rounding errors in common factors, and a
  /// random walk of those in the terms. 0: no rounding; 2^-24 is like float, 2^-53 like double.
  double unit_roundoff = 0;
  std::uint64_t seed = 1;
  /// Not null: after each stage, its arrays are recorded and then replaced by those of this other
  /// trace of the same state. Each stage is thus compared alone, without errors of earlier stages.
  /// Ends at the first array that the two traces do not have in common.
  const StepTrace* follow = nullptr;
};

}  // namespace pbf::solver_module
