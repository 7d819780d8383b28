// Finds bodies that overlap at the start.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lib/run/emit.h"

namespace pbf::inline run_module {

/// What of a start is in the same place twice. Particles of one random box are never counted
/// against each other: at random places some always are near.
struct Overlap {
  std::int64_t inside = 0;            ///< particles inside the block, sphere or box of another body
  std::int64_t pairs = 0;             ///< of two bodies, closer than half of fluid.spacing
  std::size_t first = 0, second = 0;  ///< two bodies that overlap, first < second
  std::int64_t within = 0;            ///< pairs of one file, closer than half of fluid.spacing
  std::size_t file = 0;               ///< body of the first of them
  std::int64_t of_files = 0;          ///< particles in files
  bool more = false;                  ///< there may be more pairs: 2e8 distances were looked at
};

/// Looks at the particles alone that lie within half a spacing of another body's box, or in a file.
Overlap find_overlap(const StartPoints& points);

}  // namespace pbf::inline run_module
