// Neighbor lists. The pairs of an update are those with |x*_i - x*_j| < h when the lists are made,
// on every backend. A list does not contain the particle itself and is in ascending order of the
// sorted index, so every sum over it has one order.
#pragma once

#include <cstdint>

#include "kernels/cell_index.h"
#include "kernels/rows.h"

namespace pbf::PBF_VARIANT {

/// Neighbor lists of the CPU. `width` = 2^width_bits adjacent particles form a group, whose lists
/// are interleaved: entry k of particle l of the group is at group[k width + l]. Shorter lists of a
/// group are padded with index `far`, a particle that contributes zero to every sum. Groups are
/// stored one after the other in chunks of 1024 particles.
struct ChunkedLists {
  static constexpr int chunk_bits = 10;
  static constexpr bool cheap_branches = true;  ///< for each pair, in sums of single particles
  struct Group {
    std::uint32_t begin, rounds;  ///< first entry within the chunk; length of the longest list
  };
  const int* const* chunk;  ///< first entry of each chunk
  const Group* groups;      ///< per group
  int width_bits, far;

  /// f(j) for every neighbor j of i.
  template <class F>
  PBF_HD void for_each(int i, F&& f) const {
    const int width = 1 << width_bits;
    const int* e = group(i) + (i & (width - 1));
    const int* end = e + std::ptrdiff_t(rounds(i)) * width;
    for (; e != end && *e != far; e += width) f(Neighbor{*e});
  }
  PBF_HD int size(int i) const {
    int n = 0;
    for_each(i, [&](Neighbor) { ++n; });
    return n;
  }

  /// The lists of the group of i, and the number of entries of each.
  PBF_HD const int* group(int i) const {
    return chunk[i >> chunk_bits] + groups[i >> width_bits].begin;
  }
  PBF_HD int rounds(int i) const { return int(groups[i >> width_bits].rounds); }
};

}  // namespace pbf::PBF_VARIANT
