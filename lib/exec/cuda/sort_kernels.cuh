// Kernels of the counting sort (kernels/pass_sort.h).
#pragma once

#include "kernels/pass_sort.h"
#include "lib/exec/cuda/kernel_start.cuh"
#include "lib/exec/cuda/list_pass.cuh"

namespace pbf::PBF_VARIANT {

/// Also clears the counts for the next sort, and the number of used overflows.
template <class Rows>
__global__ void __launch_bounds__(kBlock)
    place_kernel(Rows rows, PlacePass pass, int* count, ListState* lists) {
  const int n = end_of(rows);
  wait_for_previous();
  const int i = blockIdx.x * kBlock + threadIdx.x;
  if (i < n) pass(i);
  for (int b = pass.bins.begin + i; b < pass.bins.end; b += gridDim.x * kBlock) count[b] = 0;
  if (i == 0) lists->used = 0;
}

static_assert((kSortBins + 1 + 32) * sizeof(int) <= 48 * 1024, "count and warp_sum in one block");

/// One block runs `first`, which gives rows their bins, sorts and gathers. For few particles
/// (kSortParticles, kSortBins). leave: rows with a negative id leave.
template <bool leave, class Rows, class First, class Gather>
__global__ void __launch_bounds__(kSortThreads)
    small_sort_kernel(Rows rows, First first_pass, int bins, int* arrival, int* slot, int* start,
                      ListState* lists, OrderPass<leave, Gather> place) {
  const int n = end_of(rows);
  wait_for_previous();
  extern __shared__ int count[];  // of each bin
  __shared__ int warp_sum[32];
  const int t = threadIdx.x;
  const int* bin = place.bin;
  for (int b = t; b < bins; b += kSortThreads) count[b] = 0;
  __syncthreads();
  for (int i = t; i < n; i += kSortThreads) {
    first_pass(i);
    if (leave && place.id[i] < 0) continue;
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
  if (t == 0) lists->used = 0;
  if (t == kSortThreads - 1) start[bins] = before;  // of the rows that stay
  __syncthreads();
  for (int i = t; i < n; i += kSortThreads)
    if (!leave || place.id[i] >= 0) slot[count[bin[i]] + arrival[i]] = i;
  __syncthreads();
  for (int k = t; k < n; k += kSortThreads) place(k);
}

}  // namespace pbf::PBF_VARIANT
