// A state that can be passed from one solver to another, and the results of every pass of one
// update. `pbf compare` and its tests use them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/boundary/loads.h"
#include "kernels/pass_flow.h"
#include "lib/scene/scene.h"

namespace pbf::inline solver_module {

/// A state: positions in h from Scene::origin(), velocities in h/s, along the scene's axes. A
/// solver returns it in the order of ids and accepts any order.
struct SolverState {
  Precision precision = Precision::dbl;  ///< of the solver that returned it
  std::int64_t updates = 0;              ///< done so far
  std::int64_t steps = 0;                ///< done so far: above level 0 more than updates
  std::vector<double> position;          ///< 3n, h
  std::vector<double> velocity;          ///< 3n, h/s
  std::vector<std::int32_t> id;          ///< n
  /// kernels/step_counts.h, so far.
  std::int64_t fast = 0, repeats = 0, unresolved = 0;
  double way_squared = 0;
  /// One per row of sums, along the internal axes; empty: no loads were summed.
  std::vector<Load> loads{};
  std::vector<FlowCount> flows{};  ///< of each flow gauge
};

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

}  // namespace pbf::inline solver_module
