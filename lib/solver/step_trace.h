// A state that can be handed from one solver to another, and what every pass of one update left
// behind: the material of `pbf compare` and of its tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf {

/// A state in the internal frame (h from the domain's lower corner, h/s), in the solver's own order
/// of particles. The order belongs to the state: the sort by bin is stable, so particles of one bin
/// keep it, and every sum over neighbours follows it.
struct SolverState {
  Precision precision = Precision::dbl;  ///< of the solver that it came from
  std::int64_t updates = 0;              ///< done so far
  std::vector<double> position;          ///< 3n, h
  std::vector<double> velocity;          ///< 3n, h/s
  std::vector<std::int32_t> id;          ///< n
};

/// One array that a pass left behind; row = particle id.
struct TraceArray {
  std::string stage;     ///< name of the pass: predict, grid, lambda, ...
  int sweep = 0;         ///< 1, 2, ... within the iterations, 0 outside them
  std::string quantity;  ///< position, velocity, bin, density, lambda, curl
  std::string unit;      ///< of the internal frame
  int components = 1;    ///< scalars per row
  std::vector<double> values;
};

/// One update, pass by pass. A density that the lambda pass sums in its own loop stands under
/// "density" all the same.
struct StepTrace {
  std::vector<TraceArray> arrays;            ///< in the order of the passes
  std::vector<std::int64_t> neighbor_begin;  ///< n + 1: where each particle's neighbours begin
  std::vector<std::int32_t> neighbors;       ///< ids, ascending for each particle
};

/// Random rounding of everything that a pass stores, after Parker, Pierce & Eggert 2000, "Monte
/// Carlo arithmetic": value * (1 + r u), r uniform in [-1, 1). Sums over neighbours carry
/// sqrt(terms) u. unit_roundoff 0: none, and the update is step(1) to the last bit.
struct Roundings {
  double unit_roundoff = 0;  ///< u: 2^-24 for float, 2^-53 for double
  std::uint64_t seed = 1;
};

}  // namespace pbf
