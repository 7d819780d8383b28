// The kernels that launch a pass.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>
#include <type_traits>

#include "kernels/packed_position.h"
#include "lib/exec/cuda/kernel_start.cuh"
#include "lib/exec/cuda/list_pass.cuh"

namespace pbf::PBF_VARIANT {

/// Largest numbers of particles for which 16, 8, 4 and 2 threads share a neighbor sum, and for
/// which several share the making of a list (which changes no bit). Measured on an H200
/// (kernels/PERFORMANCE.md).
#ifdef PBF_PINNED
constexpr int kSixteenLanes = 6000, kEightLanes = 24000, kFourLanes = 0, kTwoLanes = 0;
#else
constexpr int kSixteenLanes = 4000, kEightLanes = 12000, kFourLanes = 40000, kTwoLanes = 100000;
#endif
constexpr int kListLanes = 40000;
/// Calls f(threads), an integral_constant: how many share a neighbor sum in a scene of `total`
/// particles. In two dimensions a list has a third of the words, enough for half as many threads.
template <int D, class F>
void with_lanes(std::int64_t total, const F& f) {
  constexpr bool space = D == 3;
  constexpr int more = space ? 2 : 1;
  if constexpr (space)
    if (total <= kSixteenLanes) return f(std::integral_constant<int, 16>{});
  if (total <= kEightLanes) return f(std::integral_constant<int, 4 * more>{});
  if constexpr (kFourLanes > 0)
    if (total <= kFourLanes) return f(std::integral_constant<int, 2 * more>{});
  if constexpr (space && kTwoLanes > 0)
    if (total <= kTwoLanes) return f(std::integral_constant<int, 2>{});
  f(std::integral_constant<int, 1>{});
}
constexpr int kRepeatBlocks = 512;
constexpr int kListedBlocks = 1024;

template <class Rows, class Pass>
__global__ void __launch_bounds__(kBlock) item_kernel(Rows rows, Pass pass) {
  const int n = end_of(rows);
  begin_pass<Pass>();
  const int i = first_of(rows) + blockIdx.x * kBlock + threadIdx.x;
  if (i < n && !leaves_out(rows, i)) pass(i);
}

/// A neighbor sum in float and three dimensions that gathers two rows of a neighbor, where only
/// walls are near. It has 40 registers, so that a multiprocessor runs 1536 threads, in blocks of up
/// to 768: adjacent particles had better be on one multiprocessor, which has their neighbors in its
/// cache.
template <class Pass>
constexpr bool kIsWide = false;
#ifndef PBF_PINNED
template <class Pass>
requires requires(Pass p) { p.boundary; }
constexpr bool kIsWide<Pass> = Pass::D == 3 &&
                               std::is_same_v<decltype(Pass::boundary), Box<float>> &&
                               sizeof(std::declval<const Pass&>().other(Neighbor{})) > 16;
#endif
/// Threads of a block, for n of one particle each.
template <class Pass>
int pair_block(int n) {
  if (!kIsWide<Pass> || n < 100000) return kBlock;
  return n < 400000 ? 512 : 768;
}
/// Blocks that run at the same time on a multiprocessor, at least: with packed positions, whose
/// gathers take less, as many as for wide sums are worth it.
template <class Pass>
constexpr int kPairBlocks = kIsWide<Pass>                                        ? 2
                            : std::is_same_v<typename Pass::Own, PackedPosition> ? 1536 / kBlock
                                                                                 : 1;
template <class Rows, class Pass>
__global__ void __launch_bounds__(kIsWide<Pass> ? 768 : kBlock, kPairBlocks<Pass>)
    pair_kernel(Rows rows, Pass pass) {
  const int n = end_of(rows);
  begin_pass<Pass>();
  const int block = kIsWide<Pass> ? blockDim.x : kBlock;
  const int i = first_of(rows) + blockIdx.x * block + threadIdx.x;
  if (i < n && !leaves_out(rows, i)) sum_over_words(pass, i);
  end_pass<Pass>();
}

/// For items 0 .. *count - 1.
template <class Pass>
__global__ void __launch_bounds__(kBlock)
    listed_kernel(const int* count, const __grid_constant__ Pass pass) {
  wait_for_previous();
  const int n = *count;
  for (int k = blockIdx.x * kBlock + threadIdx.x; k < n; k += gridDim.x * kBlock) pass(k);
}

/// The number of this thread, of which `lanes` share a row; behind those of all n rows if the row
/// is left out, because every thread of a warp takes part in shuffles.
template <int lanes, class Rows>
__device__ __forceinline__ int thread_of_row(const Rows& rows, int n) {
  const int thread = lanes * first_of(rows) + blockIdx.x * kBlock + threadIdx.x, i = thread / lanes;
  return i < n && leaves_out(rows, i) ? thread + lanes * (n - i) : thread;
}

/// A neighbor sum by several threads per particle.
template <int lanes, class Rows, class Pass>
__global__ void __launch_bounds__(kBlock) lanes_kernel(Rows rows, Pass pass) {
  const int n = end_of(rows);
  begin_pass<Pass>();
  const int thread = thread_of_row<lanes>(rows, n);
#ifdef PBF_PINNED
  sum_in_order_by_lanes<lanes, kBlock>(pass, thread, n);
#else
  sum_over_neighbors_by_lanes<lanes>(pass, thread, n);
#endif
  end_pass<Pass>();
}

/// One thread makes a list. Large blocks, because adjacent lists have most candidates in common;
/// two at a time, so that a thread has registers for four candidates.
constexpr int kListBlock = 512;
template <class Rows, class Real, int D>
__global__ void __launch_bounds__(kListBlock, 2) list_kernel(Rows rows, ListPass<Real, D> pass) {
  __shared__ HitQueue<kListBlock>::Memory memory;
  const int n = end_of(rows);
  wait_for_previous();
  const int i = first_of(rows) + blockIdx.x * kListBlock + threadIdx.x;
  pass.by_thread(i, i < n && !leaves_out(rows, i), HitQueue<kListBlock>(memory));
}
template <class Rows, class Real, int D>
__global__ void __launch_bounds__(kBlock) list_lanes_kernel(Rows rows, ListPass<Real, D> pass) {
  const int n = end_of(rows);
  wait_for_previous();
  constexpr int lanes = ListPass<Real, D>::lanes;
  const int thread = thread_of_row<lanes>(rows, n), i = thread / lanes;
  pass.by_lanes(i, thread % lanes, i < n);
}

}  // namespace pbf::PBF_VARIANT
