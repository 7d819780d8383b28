// Neighbour lists. The pairs of an update are those with |x*_i - x*_j| < h when the lists are made,
// on every backend; a list leaves out the particle itself and is in ascending order of the sorted
// index, so every sum over it has one order.
#pragma once

#include <cstdint>

#include "kernels/cell_index.h"

namespace pbf::inline PBF_VARIANT {

/// Neighbour policy: lists in chunks of 1024 particles, each chunk contiguous (the CPU's layout).
struct ChunkedLists {
  static constexpr int chunk_bits = 10;
  static constexpr bool skip_inactive = true;  ///< a branch per pair pays on the CPU
  const int* const* chunk;                     ///< first entry of each chunk
  const std::uint32_t* begin;                  ///< per particle, within its chunk
  const std::uint32_t* count;                  ///< per particle

  /// f(j) for every neighbour j of i.
  template <class F>
  PBF_HD void for_each(int i, F&& f) const {
    const int* e = chunk[i >> chunk_bits] + begin[i];
    const int* end = e + count[i];
    for (; e != end; ++e) f(*e);
  }
  PBF_HD int size(int i) const { return int(count[i]); }
};

}  // namespace pbf::inline PBF_VARIANT
