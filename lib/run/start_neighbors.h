// Where an initial state is denser than fluid at rest, before its particles are created: numbers of
// neighbors, and bodies that overlap.
#pragma once

#include <cstdint>

#include "lib/program/plan.h"
#include "lib/run/emit.h"

namespace pbf::run_module {

/// Empty if no place can be denser than fluid at rest: blocks and spheres without overlap. Takes
/// time proportional to `particles` (count_particles()), and memory only for the sample. The sample
/// of a scene is always the same. Positions outside the domain are no error here.
StartNeighbors start_neighbors(const StartPoints& points, std::int64_t particles);

/// Overlaps in an initial state. Pairs within one random box are never counted: some random
/// positions are always close.
struct Overlap {
  std::int64_t inside = 0;            ///< particles inside the block, sphere or box of another body
  std::int64_t pairs = 0;             ///< of two bodies, closer than half of fluid.spacing
  std::size_t first = 0, second = 0;  ///< two bodies that overlap, first < second
  std::int64_t within = 0;            ///< pairs of one file, closer than half of fluid.spacing
  std::size_t file = 0;               ///< body of the first such pair
  std::int64_t of_files = 0;          ///< particles in files
  bool more = false;                  ///< there may be more: the search ended after 2e8 distances
};

/// Examines only particles within half a spacing of another body's box, and those of files.
Overlap find_overlap(const StartPoints& points);

}  // namespace pbf::run_module
