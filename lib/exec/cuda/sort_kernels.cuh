// Kernels of the counting sort by bin, within a bin by id.
#pragma once

#include "kernels/pair_sum.h"
#include "kernels/pass_shapes.h"
#include "lib/exec/cuda/kernel_start.cuh"
#include "lib/exec/cuda/list_pass.cuh"

namespace pbf::inline PBF_VARIANT {

/// Runs `First`, which gives a particle its bin, and then stores the particle's number in that bin
/// in order of arrival.
template <class First>
struct CountPass : First {
  int *count, *arrival;
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
    const int bin = First::bin[i];
    if (bin < 0) return;  // left to a pass over listed rows
    arrival[i] = atomicAdd(&count[bin], 1);
  }
};
/// Sorts rows by bin. Also clears the counters for the next sort and the number of used overflows.
struct PlacePass {
  const int *bin, *start, *arrival;
  int *slot, *count;
  ListState* lists;
  int n, bins;
  __device__ void operator()(int i) const {
    slot[start[bin[i]] + arrival[i]] = i;
    for (int b = i; b < bins; b += n) count[b] = 0;
    if (i == 0) lists->used = 0;
  }
};
/// Moves the particles of a bin to the order of their ids, so that the order of rows follows from
/// the positions alone: each thread counts the particles of the bin with smaller ids.
template <class Gather>
struct OrderPass {
  const int *bin, *id, *start, *slot;
  Gather gather;
  __device__ void operator()(int k) const {
    const int i = slot[k], b = bin[i], mine = id[i], begin = start[b], end = start[b + 1];
    int place = begin;
    for (int m = begin; m < end; ++m)
      if (m != k) place += id[slot[m]] < mine ? 1 : 0;
    gather(i, place);
  }
};

static_assert((kSortBins + 32) * sizeof(int) <= 48 * 1024, "count and warp_sum in one block");

/// One block runs `first` (see CountPass), sorts and gathers. For few particles (kSortParticles,
/// kSortBins).
template <class First, class Gather>
__global__ void __launch_bounds__(kSortThreads)
    small_sort_kernel(First first_pass, int n, int bins, int* arrival, int* slot, int* start,
                      ListState* lists, OrderPass<Gather> place) {
  wait_for_previous();
  extern __shared__ int count[];  // bins
  __shared__ int warp_sum[32];
  const int t = threadIdx.x;
  const int* bin = place.bin;
  for (int b = t; b < bins; b += kSortThreads) count[b] = 0;
  __syncthreads();
  for (int i = t; i < n; i += kSortThreads) {
    first_pass(i);
    arrival[i] = atomicAdd(&count[bin[i]], 1);
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
    start[bins] = n;
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

}  // namespace pbf::inline PBF_VARIANT
