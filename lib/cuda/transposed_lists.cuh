// Neighbour lists for coalesced reading: word k of 4 entries of particle i lies at
// entries[4 (k stride + i)], so the lanes of a warp read adjacent 16-byte words.
#pragma once

#include "kernels/pair_sum.h"

namespace pbf::inline PBF_VARIANT {

/// Neighbour policy. Unused entries of the last word name the far particle (index n), whose
/// contribution to every sum is zero: no test per entry.
struct TransposedLists {
  static constexpr bool skip_inactive = false;  ///< a branch per pair costs more than the pair
  const int4* words = nullptr;
  const int* count = nullptr;  ///< neighbours stored for each particle
  int stride = 0;              ///< words between word k and k + 1 of one particle

  /// f(j) for every neighbour j of i, or for the share of one of `lanes` threads.
  template <class F>
  __device__ __forceinline__ void for_each(int i, F&& f, int lane = 0, int lanes = 1) const {
    const int n = (count[i] + 3) >> 2;
    const int4* w = words + i + std::size_t(lane) * stride;
    for (int k = lane; k < n; k += lanes, w += std::size_t(lanes) * stride) {
      const int4 j = __ldg(w);
      f(j.x);
      f(j.y);
      f(j.z);
      f(j.w);
    }
  }
  __device__ __forceinline__ int size(int i) const { return count[i]; }
};

/// Several threads share the neighbours of one particle: for few particles, where a pass waits for
/// memory rather than for arithmetic. Their sums are added in a tree of fixed shape.
template <int lanes, class Pass>
__device__ __forceinline__ void sum_over_neighbors_by_lanes(const Pass& pass, int thread, int n) {
  const int i = thread / lanes, lane = thread % lanes;
  const bool valid = i < n;  // every lane of the warp takes part in the shuffles
  typename Pass::Own own{};
  typename Pass::Sum sum{};
  if (valid) {
    own = pass.own(i);
    pass.lists.for_each(
        i, [&](int j) { pass.add(sum, own, pass.other(j), i, j, true); }, lane, lanes);
  }
  sum.each([](auto& x) {
#pragma unroll
    for (int half = lanes / 2; half > 0; half /= 2) x += __shfl_xor_sync(0xffffffffu, x, half);
  });
  if (valid && lane == 0) pass.finish(i, own, sum);
}

}  // namespace pbf::inline PBF_VARIANT
