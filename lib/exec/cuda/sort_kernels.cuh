// Kernels of the counting sort (kernels/pass_sort.h).
#pragma once

#include "kernels/pass_sort.h"
#include "lib/exec/cuda/kernel_start.cuh"
#include "lib/exec/cuda/list_pass.cuh"

namespace pbf::PBF_VARIANT {

static_assert((kSortBins + 1 + kSortParticles + 32) * sizeof(int) <= 48 * 1024,
              "counts, ids and warp_sum in one block");

/// Also clears the number of used overflows.
template <class Rows>
__global__ void __launch_bounds__(kBlock)
    place_kernel(Rows rows, PlacePass pass, ListState* lists) {
  const int n = end_of(rows);
  wait_for_previous();
  const int i = blockIdx.x * kBlock + threadIdx.x;
  if (i < n) pass(i);
  if (i == 0) lists->used = 0;
}

/// One block runs `first`, which gives rows their bins, sorts and gathers. For few particles
/// (kSortParticles, kSortBins), whose bins and ids stay in registers and shared memory. leave: rows
/// with a negative id leave.
template <bool leave, class Rows, class First, class Gather>
__global__ void __launch_bounds__(kSortThreads)
    small_sort_kernel(Rows rows, First first_pass, int bins, int* start, ListState* lists,
                      OrderPass<leave, Gather> order) {
  const int n = end_of(rows);
  wait_for_previous();
  extern __shared__ int count[];  // of each bin, and then its first row
  int* const slot = count + bins + 1;
  __shared__ int warp_sum[32];
  const int t = threadIdx.x;
  constexpr int most = (kSortParticles + kSortThreads - 1) / kSortThreads;
  int bin[most], id[most], arrival[most];
#pragma unroll
  for (int r = 0; r < most; ++r) {
    const int i = t + r * kSortThreads;
    bin[r] = -1;
    if (i >= n) continue;
    first_pass(i);
    id[r] = order.id[i];
    if (!leave || id[r] >= 0) bin[r] = order.bin[i];
  }
  for (int b = t; b < bins; b += kSortThreads) count[b] = 0;
  __syncthreads();
#pragma unroll
  for (int r = 0; r < most; ++r)
    if (bin[r] >= 0) arrival[r] = atomicAdd(&count[bin[r]], 1);
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
  if (t == kSortThreads - 1) count[bins] = start[bins] = before;  // of the rows that stay
  __syncthreads();
#pragma unroll
  for (int r = 0; r < most; ++r)
    if (bin[r] >= 0) slot[count[bin[r]] + arrival[r]] = id[r];
  __syncthreads();
#pragma unroll
  for (int r = 0; r < most; ++r) {
    if (bin[r] < 0) continue;
    order.gather(t + r * kSortThreads, place_in_bin(slot, count[bin[r]], count[bin[r] + 1], id[r]));
  }
}

}  // namespace pbf::PBF_VARIANT
