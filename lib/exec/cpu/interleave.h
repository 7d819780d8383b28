// Interleaves the lists of a group of particles (kernels/neighbors.h, ChunkedLists).
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "kernels/lanes.h"
#include "lib/program/simd.h"

namespace pbf::PBF_VARIANT {

/// Entries of each list that are interleaved together; so many copies of `far` follow each list.
constexpr int kAtOnce = 16;

/// The lists of a group, one after the other in memory.
struct GroupLists {
  std::size_t begin[16];  ///< first entry of each list
  int size[16], longest = 0;
};

/// W lists at once: transposes blocks of W x W entries. May write kAtOnce W more entries.
template <int W>
PBF_HD void interleave_by_lanes(const int* single, const GroupLists& lists, int far, int* to) {
  typedef int Row __attribute__((vector_size(W * sizeof(int)), aligned(sizeof(int)), may_alias));
  typedef int Ints __attribute__((vector_size(W * sizeof(int))));
  int beyond[W];
  for (int l = 0; l < W; ++l) beyond[l] = far;
  for (int k = 0; k < lists.longest; k += W, to += W * W) {
    Ints row[W];
    for (int l = 0; l < W; ++l) {
      const int* from = k < lists.size[l] ? single + lists.begin[l] + k : beyond;
      row[l] = *reinterpret_cast<const Row*>(from);
    }
    // Each step interleaves the first half of the rows with the second one.
    const auto step = [&]<int... l>(std::integer_sequence<int, l...>)
        __attribute__((always_inline)) {
      Ints next[W];
      for (int r = 0; r < W / 2; ++r) {
        next[2 * r] = __builtin_shufflevector(row[r], row[r + W / 2], (l / 2 + l % 2 * W)...);
        next[2 * r + 1] =
            __builtin_shufflevector(row[r], row[r + W / 2], (W / 2 + l / 2 + l % 2 * W)...);
      }
      for (int r = 0; r < W; ++r) row[r] = next[r];
    };
    for (int steps = 1; steps < W; steps *= 2) step(std::make_integer_sequence<int, W>{});
    for (int r = 0; r < W; ++r) *reinterpret_cast<Row*>(to + r * W) = row[r];
  }
}
#ifdef PBF_HAS_AVX
PBF_AVX2 inline void interleave_by_avx2(int bits, const int* single, const GroupLists& lists,
                                        int far, int* to) {
  if (bits == 3) return interleave_by_lanes<8>(single, lists, far, to);
  interleave_by_lanes<4>(single, lists, far, to);
}
PBF_AVX512 inline void interleave_by_avx512(int bits, const int* single, const GroupLists& lists,
                                            int far, int* to) {
  if (bits == 4) return interleave_by_lanes<16>(single, lists, far, to);
  interleave_by_lanes<8>(single, lists, far, to);
}
#endif

/// Entry k of list l goes to to[(k << bits) + l], `far` where a list has ended; 2^bits lists.
inline void interleave(Simd simd, int bits, const int* single, const GroupLists& lists, int far,
                       int* to) {
  switch (simd) {
#ifdef PBF_HAS_AVX
    case Simd::avx2:
      return interleave_by_avx2(bits, single, lists, far, to);
    case Simd::avx512:
      return interleave_by_avx512(bits, single, lists, far, to);
#endif
    default:
      if (bits == 2) return interleave_by_lanes<4>(single, lists, far, to);
      if (bits == 1) return interleave_by_lanes<2>(single, lists, far, to);
      std::copy_n(single + lists.begin[0], lists.longest, to);
  }
}

}  // namespace pbf::PBF_VARIANT
