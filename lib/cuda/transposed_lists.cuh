// Neighbour lists for coalesced reading: word k of 4 entries of particle i lies at
// entries[4 (k stride + i)], so the lanes of a warp read adjacent 16-byte words.
#pragma once

#include "kernels/neighbors.h"

namespace pbf {

/// Neighbour policy. Unused entries of the last word name the far particle (index n), whose
/// contribution to every sum is zero: no test per entry.
struct TransposedLists {
  static constexpr bool skip_inactive = false;  ///< a branch per pair costs more than the pair
  const int4* words = nullptr;
  const int* count = nullptr;  ///< neighbours stored for each particle
  int stride = 0;              ///< words between word k and k + 1 of one particle

  template <class F>
  __device__ __forceinline__ void for_each(int i, F&& f) const {
    const int n = (count[i] + 3) >> 2;
    const int4* w = words + i;
    for (int k = 0; k < n; ++k, w += stride) {
      const int4 j = __ldg(w);
      f(j.x);
      f(j.y);
      f(j.z);
      f(j.w);
    }
  }
  __device__ __forceinline__ int size(int i) const { return count[i]; }
};

/// Packs neighbours four at a time in registers and writes whole words.
struct WordWriter {
  int4* out;
  int stride, capacity, found = 0;
  int4 word{0, 0, 0, 0};

  __device__ __forceinline__ void operator()(int j) {
    word = {word.y, word.z, word.w, j};
    ++found;
    if ((found & 3) == 0 && found <= capacity) {
      *out = word;
      out += stride;
    }
  }
  /// Fills up the last word with `far`; returns the number of neighbours.
  __device__ __forceinline__ int finish(int far) {
    const int all = found;
    if (all < capacity)
      while (found & 3) (*this)(far);
    return all;
  }
};

}  // namespace pbf
