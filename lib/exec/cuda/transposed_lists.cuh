// Neighbor lists for coalesced reading: word k of 4 entries of particle i is at
// words[k stride + i], so the lanes of a warp read adjacent 16-byte words. All lists have the same
// capacity; the few longer ones also take an overflow block from a common pool.
#pragma once

#include <type_traits>

#include "kernels/pair_sum.h"
#include "lib/exec/cuda/kernel_start.cuh"
#include "lib/program/list_capacity.h"

namespace pbf::PBF_VARIANT {

/// Loads a word that is read once and by no pass soon, without displacing positions from the L1
/// cache.
__device__ __forceinline__ int4 load_once(const int4* word) {
  int4 w;
  asm("ld.global.nc.L1::no_allocate.v4.s32 {%0, %1, %2, %3}, [%4];"
      : "=r"(w.x), "=r"(w.y), "=r"(w.z), "=r"(w.w)
      : "l"(word));
  return w;
}

/// The largest n of the threads of a warp.
__device__ __forceinline__ int largest_of_warp(int n) {
#if __CUDA_ARCH__ >= 800
  return __reduce_max_sync(0xffffffffu, n);
#else
  for (int half = 16; half > 0; half /= 2) n = max(n, __shfl_xor_sync(0xffffffffu, n, half));
  return n;
#endif
}

/// Where word k of the list of particle i is: its first words are `stride` apart, the others in its
/// overflow.
template <class Word>
__device__ __forceinline__ Word* word_of_list(Word* words, int stride, int first, Word* overflow,
                                              int i, int k) {
  return k < first ? words + i + std::size_t(k) * stride : overflow + (k - first);
}

/// Neighbor lists of the GPU. Unused entries of the last word are the far particle (index n), which
/// contributes zero to every sum, so entries need no test.
struct TransposedLists {
  static constexpr bool cheap_branches = false;  ///< one per pair costs more than the pair
  const int4 *words = nullptr, *overflows = nullptr;
  const int* count = nullptr;        ///< neighbors stored for each particle
  const int* overflow_of = nullptr;  ///< number of its overflow, if count is above 4 first
  int stride = 0;                    ///< words between word k and k + 1 of one particle
  int first = 0, overflow = 0;       ///< see ListCapacity
  int far = 0;                       ///< the row that pads lists

  /// f(j) for every neighbor j of i, or for the share of one of `lanes` threads.
  template <class F>
  __device__ __forceinline__ void for_each(int i, F&& f, int lane = 0, int lanes = 1) const {
    const int n = (count[i] + 3) >> 2;
    const int4* w = words + i + std::size_t(lane) * stride;
    std::size_t step = std::size_t(lanes) * stride;
    for (int k = lane; k < n; k += lanes, w += step) {
      if (k >= first && k < first + lanes) {
        w = overflows + std::size_t(overflow_of[i]) * overflow + (k - first);
        step = lanes;
      }
      const int4 j = load_once(w);
      f(Neighbor{j.x});
      f(Neighbor{j.y});
      f(Neighbor{j.z});
      f(Neighbor{j.w});
    }
  }
  /// f(word) for every word of i. Each is loaded while the neighbors in the one before are added.
  template <class F>
  __device__ __forceinline__ void for_each_word(int i, F&& f) const {
    const int n = (count[i] + 3) >> 2, inner = min(n, first);
    const int4* w = words + i;
    int k = 0;
    int4 next;
    if (k < inner) next = load_once(w);
    for (; k < inner; ++k) {
      const int4 now = next;
      w += stride;
      if (k + 1 < inner) next = load_once(w);
      f(now);
    }
    if (k >= n) return;
    w = overflows + std::size_t(overflow_of[i]) * overflow;
    for (; k < n; ++k, ++w) f(load_once(w));
  }
  /// f(four) for four entries at a time of the share of one of `lanes` threads: lane, lane + lanes,
  /// ..., so that the shares differ by at most one entry. Padded with the far particle.
  template <int lanes, class F>
  __device__ __forceinline__ void for_each_share(int i, int lane, F&& f) const {
    const int n = count[i];
    const int4* o = overflow_words(i, n);
    const auto some = [&](int e) { return e < n ? entry(i, e, o) : far; };
    for (int e = lane; e < n; e += 4 * lanes)
      f(int4{some(e), some(e + lanes), some(e + 2 * lanes), some(e + 3 * lanes)});
  }
  /// Word k of particle i.
  __device__ __forceinline__ int4 word(int i, int k) const {
    return load_once(word_of_list(words, stride, first, overflow_words(i, 4 * k + 1), i, k));
  }
  /// Null if a list of n entries has none.
  __device__ __forceinline__ const int4* overflow_words(int i, int n) const {
    return n > 4 * first ? overflows + std::size_t(overflow_of[i]) * overflow : nullptr;
  }
  /// o: overflow_words(i).
  __device__ __forceinline__ int entry(int i, int e, const int4* o) const {
    const int4* word = word_of_list(words, stride, first, o, i, e >> 2);
    return reinterpret_cast<const int*>(word)[e & 3];
  }
  __device__ __forceinline__ int size(int i) const { return count[i]; }
};

/// Adds the neighbors in a word. All four are loaded before the first is added.
template <class Pass, class Own, class Sum>
__device__ __forceinline__ void add_word(const Pass& pass, Sum& sum, const Own& own,
                                         const int4& word) {
  const auto a = pass.other(Neighbor{word.x}), b = pass.other(Neighbor{word.y}),
             c = pass.other(Neighbor{word.z}), d = pass.other(Neighbor{word.w});
  pass.add(sum, own, a);
  pass.add(sum, own, b);
  pass.add(sum, own, c);
  pass.add(sum, own, d);
}

/// sum_over_neighbors() of one thread (kernels/pair_sum.h), with the same bits.
template <class Pass>
__device__ __forceinline__ void sum_over_words(const Pass& pass, int i) {
  const auto own = pass.own(i);
  typename Pass::Sum sum{};
  pass.lists.for_each_word(i, [&](const int4& word) { add_word(pass, sum, own, word); });
  finish_pass(pass, i, own, sum);
}

/// Several threads share the neighbors of one particle: for few particles, where a pass waits for
/// memory rather than for arithmetic. Their sums are added in a tree of fixed shape. In float and
/// three dimensions, shares and tree of 4 threads and more are those of turns.cuh; 2 threads take
/// every other word. In double or two dimensions a thread adds the neighbors of its words one by
/// one: four at a time took longer (kernels/PERFORMANCE.md).
template <int lanes, class Pass>
__device__ __forceinline__ void sum_over_neighbors_by_lanes(const Pass& pass, int thread, int n) {
  const int i = thread / lanes, lane = thread % lanes;
  const bool valid = i < n;  // every lane of the warp takes part in the shuffles
  typename Pass::Own own{};
  typename Pass::Sum sum{};
  if (valid) {
    own = pass.own(i);
    if constexpr (sizeof(pass.p.dt) == 4 && Pass::D == 3 && lanes > 2)
      pass.lists.template for_each_share<lanes>(
          i, lane, [&](const int4& four) { add_word(pass, sum, own, four); });
    else if constexpr (sizeof(pass.p.dt) == 4 && Pass::D == 3)
      for (int k = lane; 4 * k < pass.lists.size(i); k += lanes)
        add_word(pass, sum, own, pass.lists.word(i, k));
    else
      pass.lists.for_each(
          i, [&](Neighbor j) { pass.add(sum, own, pass.other(j)); }, lane, lanes);
  }
  sum.each([](auto& x) {
#pragma unroll
    for (int half = lanes / 2; half > 0; half /= 2) x += __shfl_xor_sync(0xffffffffu, x, half);
  });
  if (valid && lane == 0) finish_pass(pass, i, own, sum);
}

/// The same with the bits of a sum by one thread. The threads compute 4 * lanes terms at a time and
/// store them in shared memory; then each adds one component in the order of the list.
template <int lanes, int block, class Pass>
__device__ __forceinline__ void sum_in_order_by_lanes(const Pass& pass, int thread, int n) {
  using Real = std::remove_cv_t<decltype(pass.p.dt)>;
  using Sum = typename Pass::Sum;
  constexpr int parts = sizeof(Sum) / sizeof(Real), entries = 4 * lanes;
  __shared__ Real terms[block / lanes][entries][parts];
  auto& mine = terms[threadIdx.x / lanes];
  const int i = thread / lanes, lane = thread % lanes;
  const bool valid = i < n;
  const int words = valid ? (pass.lists.size(i) + 3) >> 2 : 0;
  typename Pass::Own own{};
  if (valid) own = pass.own(i);
  Real total[(parts + lanes - 1) / lanes] = {};
  // Every lane of the warp goes through as many rounds as the longest list of the warp needs.
  for (int first = 0; __any_sync(0xffffffffu, first < words); first += lanes) {
    if (first + lane < words) {
      const int4 word = pass.lists.word(i, first + lane);
      const int j[4] = {word.x, word.y, word.z, word.w};
#pragma unroll
      for (int e = 0; e < 4; ++e) {
        Sum term{};
        pass.add(term, own, pass.other(Neighbor{j[e]}));
        const Real* part = reinterpret_cast<const Real*>(&term);
        for (int c = 0; c < parts; ++c) mine[4 * lane + e][c] = part[c];
      }
    }
    __syncwarp();
    const int there = min(lanes, words - first) * 4;
    for (int c = lane, k = 0; c < parts; c += lanes, ++k)
#pragma unroll 8
      for (int e = 0; e < there; ++e) total[k] += mine[e][c];
    __syncwarp();
  }
  for (int c = lane, k = 0; c < parts; c += lanes, ++k) mine[0][c] = total[k];
  __syncwarp();
  if (!valid || lane != 0) return;
  Sum sum;
  for (int c = 0; c < parts; ++c) reinterpret_cast<Real*>(&sum)[c] = mine[0][c];
  finish_pass(pass, i, own, sum);
}

}  // namespace pbf::PBF_VARIANT
