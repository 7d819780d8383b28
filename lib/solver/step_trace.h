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

/// A state in h from Scene::origin() and h/s, along the scene's axes. A solver gives it in the
/// order of ids and takes any order: that of its rows follows from the positions.
struct SolverState {
  Precision precision = Precision::dbl;  ///< of the solver that it came from
  std::int64_t updates = 0;              ///< done so far
  std::int64_t steps = 0;                ///< of them: more than updates at levels above 0
  std::vector<double> position;          ///< 3n, h
  std::vector<double> velocity;          ///< 3n, h/s
  std::vector<std::int32_t> id;          ///< n
  /// kernels/step_counts.h, so far.
  std::int64_t fast = 0, repeats = 0, unresolved = 0;
  double way_squared = 0;
  /// Of each wall that has any, along the internal axes; none: nothing was summed.
  std::vector<Load> loads{};
  std::vector<FlowCount> flows{};  ///< of each flow gauge
};

/// One array that a pass left behind, along the scene's axes; row = particle id.
struct TraceArray {
  std::string stage;     ///< name of the pass: predict, grid, lambda, ...
  int iteration = 0;     ///< 1, 2, ... within the iterations, 0 outside them
  std::string quantity;  ///< position, velocity, bin, density, lambda, curl ...
  std::string unit;      ///< of the internal frame
  int components = 1;    ///< scalars per row
  std::vector<double> values;
  /// By the pass that made it, for the next array: values that take its place come too late there.
  bool used_at_once = false;
};

/// One update, pass by pass. A density that the lambda pass sums in its own loop stands under
/// "density" all the same.
struct StepTrace {
  std::vector<TraceArray> arrays;            ///< in the order of the passes
  std::vector<std::int64_t> neighbor_begin;  ///< n + 1: where each particle's neighbours begin
  std::vector<std::int32_t> neighbors;       ///< ids, ascending for each particle
};

/// How an update is traced. As it stands, the update is step(1) to the last bit.
struct TraceOptions {
  /// Rounds everything that a pass stores at random, after Parker, Pierce & Eggert 2000, "Monte
  /// Carlo arithmetic": value * (1 + r u), r uniform in [-1, 1). Sums over neighbours carry
  /// (4 + sqrt(terms)) u: factors that all terms share, and a random walk over those of the longest
  /// sum. 0: none; 2^-24 stands for float, 2^-53 for
  /// double.
  double unit_roundoff = 0;
  std::uint64_t seed = 1;
  /// After every stage its arrays are recorded, then replaced by these values of another trace of
  /// the same state, so that each stage is seen alone: no error is inherited. Ends where the two
  /// traces cease to have the same arrays.
  const StepTrace* follow = nullptr;
};

}  // namespace pbf::inline solver_module
