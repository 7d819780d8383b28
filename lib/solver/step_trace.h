// A state that can be handed from one solver to another.
#pragma once

#include <cstdint>
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

}  // namespace pbf
