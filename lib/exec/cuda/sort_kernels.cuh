// Kernels of the counting sort by bin, within a bin by id.
#pragma once

#include "kernels/pair_sum.h"
#include "kernels/pass_shapes.h"
#include "lib/exec/cuda/kernel_start.cuh"
#include "lib/exec/cuda/list_pass.cuh"

namespace pbf::PBF_VARIANT {

/// Rows with a negative id leave: they get a bin behind all others.
template <bool leave>
__device__ __forceinline__ int bin_of_row(int* bin, const int* id, int bins, int i) {
  if constexpr (leave)
    if (id[i] < 0) bin[i] = bins;
  return bin[i];
}

/// Runs `First`, which gives a particle its bin, and then stores the particle's number in that bin
/// in order of arrival.
template <bool leave, class First>
struct CountPass : First {
  int *count, *arrival;
  const int* id;
  int bins;
  __device__ void operator()(int i) const requires ItemPass<First> {
    First::operator()(i);
    arrive(row_of(static_cast<const First&>(*this), i, 0));
  }
  template <class Own, class Sum>
  __device__ void finish(int i, const Own& own, const Sum& sum) const {
    First::finish(i, own, sum);
    arrive(i);
  }
  /// For a pass over listed rows.
  template <class Pass>
  __device__ static auto row_of(const Pass& pass, int k, int) -> decltype(pass.row(k)) {
    return pass.row(k);
  }
  template <class Pass>
  __device__ static int row_of(const Pass&, int i, long) {
    return i;
  }
  __device__ void arrive(int i) const {
    const int bin = bin_of_row<leave>(First::bin, id, bins, i);
    if (bin < 0) return;  // left to a pass over listed rows
    arrival[i] = atomicAdd(&count[bin], 1);
  }
};
/// Sorts rows by bin. Also clears the counters for the next sort and the number of used overflows.
struct PlacePass {
  const int *bin, *start, *arrival;
  int *slot, *count;
  ListState* lists;
  int bins;
  __device__ void operator()(int i, int n) const {
    if (i < n) slot[start[bin[i]] + arrival[i]] = i;
    for (int b = i; b < bins; b += gridDim.x * kBlock) count[b] = 0;
    if (i == 0) lists->used = 0;
  }
};
template <class Rows>
__global__ void __launch_bounds__(kBlock) place_kernel(Rows rows, PlacePass pass) {
  const int n = end_of(rows);
  wait_for_previous();
  pass(blockIdx.x * kBlock + threadIdx.x, n);
}
/// Moves the particles of a bin to the order of their ids, so that the order of rows follows from
/// the positions alone: each thread counts the particles of the bin with smaller ids.
template <bool leave, class Gather>
struct OrderPass {
  int* bin;
  const int *id, *start, *slot;
  int bins;
  Gather gather;
  __device__ void operator()(int k) const {
    const int i = slot[k], b = bin[i];
    if (leave && b == bins) return;
    const int mine = id[i], begin = start[b], end = start[b + 1];
    int place = begin;
    for (int m = begin; m < end; ++m)
      if (m != k) place += id[slot[m]] < mine ? 1 : 0;
    gather(i, place);
  }
};

static_assert((kSortBins + 1 + 32) * sizeof(int) <= 48 * 1024, "count and warp_sum in one block");

/// One block runs `first` (see CountPass), sorts and gathers. For few particles (kSortParticles,
/// kSortBins).
template <bool leave, class Rows, class First, class Gather>
__global__ void __launch_bounds__(kSortThreads)
    small_sort_kernel(Rows rows, First first_pass, int bins, int* arrival, int* slot, int* start,
                      ListState* lists, OrderPass<leave, Gather> place) {
  const int n = end_of(rows);
  wait_for_previous();
  extern __shared__ int count[];  // bins, and one for rows that leave
  __shared__ int warp_sum[32];
  const int t = threadIdx.x;
  const int* bin = place.bin;
  for (int b = t; b < bins + leave; b += kSortThreads) count[b] = 0;
  __syncthreads();
  for (int i = t; i < n; i += kSortThreads) {
    first_pass(i);
    arrival[i] = atomicAdd(&count[bin_of_row<leave>(place.bin, place.id, bins, i)], 1);
  }
  __syncthreads();
  // Exclusive scan: a run of bins per thread (an odd number, against bank conflicts), then the sums
  // of threads within warps, then those of warps. cub::BlockScan is slower here
  // (kernels/PERFORMANCE.md, "Libraries").
  const int run = ((bins + kSortThreads - 1) / kSortThreads) | 1;
  const int first = min(t * run, bins), last = min(first + run, bins);
  int sum = 0;
  for (int b = first; b < last; ++b) sum += count[b];
  int before = sum;
  for (int d = 1; d < 32; d *= 2) {
    const int other = __shfl_up_sync(0xffffffffu, before, d);
    if (t % 32 >= d) before += other;
  }
  if (t % 32 == 31) warp_sum[t / 32] = before;
  __syncthreads();
  if (t < 32) {
    const int mine = warp_sum[t];
    int all = mine;
    for (int d = 1; d < 32; d *= 2) {
      const int other = __shfl_up_sync(0xffffffffu, all, d);
      if (t >= d) all += other;
    }
    warp_sum[t] = all - mine;
  }
  __syncthreads();
  before += warp_sum[t / 32] - sum;
  for (int b = first; b < last; ++b) {
    const int mine = count[b];
    count[b] = start[b] = before;
    before += mine;
  }
  if (t == 0) {
    const int kept = leave ? n - count[bins] : n;
    if (leave) count[bins] = kept;
    start[bins] = kept;
    lists->used = 0;
  }
  __syncthreads();
  for (int i = t; i < n; i += kSortThreads) slot[count[bin[i]] + arrival[i]] = i;
  __syncthreads();
  for (int k = t; k < n; k += kSortThreads) place(k);
}
/// For particles that already have their bin.
struct NothingFirst {
  __device__ void operator()(int) const {}
};

}  // namespace pbf::PBF_VARIANT
