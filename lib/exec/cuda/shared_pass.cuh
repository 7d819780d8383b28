// Passes whose items several threads share: each makes a part, and parts of whole numbers add up in
// any order (kernels/pass_level_cells.h).
#pragma once

#include <type_traits>

#include "lib/exec/cuda/kernel_start.cuh"

namespace pbf::inline PBF_VARIANT {

/// The sum over `lanes` <= 32 threads side by side, in the first of them.
template <class Part>
__device__ __forceinline__ Part sum_of_lanes(Part mine, int lanes) {
  static_assert(std::is_trivially_copyable_v<Part> && sizeof(Part) % 4 == 0);
  const unsigned mine_first = threadIdx.x % 32 / lanes * lanes;
  const unsigned mask = ~0u >> (32 - lanes) << mine_first;
  for (int step = lanes / 2; step > 0; step /= 2) {
    unsigned words[sizeof(Part) / 4];
    memcpy(words, &mine, sizeof(Part));
    for (unsigned& w : words) w = __shfl_down_sync(mask, w, step, lanes);
    Part other;
    memcpy(&other, words, sizeof(Part));
    mine += other;
  }
  return mine;
}

template <class Pass>
__global__ void __launch_bounds__(kBlock) shared_kernel(int n, const __grid_constant__ Pass pass) {
  wait_for_previous();
  constexpr int lanes = Pass::lanes;
  const int thread = blockIdx.x * kBlock + threadIdx.x, i = thread / lanes, lane = thread % lanes;
  typename Pass::Part mine{};
  if (i < n) mine = pass.part(i, lane, lanes);
  mine = sum_of_lanes(mine, lanes);
  if (i < n && lane == 0) pass.finish(i, mine);
}

/// A block of a brick (kernels/levels.h).
template <class Pass>
constexpr int kBrickBlock = Pass::brick_cells* Pass::lanes;
template <class Pass>
__global__ void __launch_bounds__(kBrickBlock<Pass>)
    brick_kernel(const __grid_constant__ Pass pass) {
  __shared__ std::int64_t found[Pass::brick_cells];
  wait_for_previous();
  const GridPlace brick = pass.brick(blockIdx.x);
  const int k = threadIdx.x / Pass::lanes, lane = threadIdx.x % Pass::lanes;
  const GridPlace c = pass.cell(brick, k);
  const bool there = pass.grid.has(c);
  typename Pass::Part mine{};
  if (there) mine = pass.part(c, lane, Pass::lanes);
  mine = sum_of_lanes(mine, Pass::lanes);
  if (lane == 0) found[k] = there ? pass.finish(c, mine) : 0;
  __syncthreads();
  constexpr int warps = kBrickBlock<Pass> / 32;
  for (int which = threadIdx.x / 32; which < Pass::brick_corners; which += warps) {
    decltype(pass.share(0, 0, 0)) sum{};
    for (int j = threadIdx.x % 32; j < Pass::brick_cells; j += 32)
      sum += pass.share(which, j, found[j]);
    sum = sum_of_lanes(sum, 32);
    if (threadIdx.x % 32 == 0) pass.finish_corner(brick, which, sum);
  }
}

/// Groups of items that are shared by 32 threads and fewer, or by a block. A block is of one group.
constexpr int kTeam = 512;
template <class Pass>
__host__ __device__ int team_blocks(const Pass& pass, int group) {
  return int((std::int64_t(pass.size(group)) * pass.lanes(group, kTeam) + kTeam - 1) / kTeam);
}
template <class Pass>
__global__ void __launch_bounds__(kTeam) team_kernel(const __grid_constant__ Pass pass) {
  using Part = typename Pass::Part;
  __shared__ Part of_warp[kTeam / 32];
  wait_for_previous();
  int group = 0, first = 0, block = blockIdx.x;
  for (int b; block >= (b = team_blocks(pass, group)); block -= b) first += pass.size(group++);
  const int lanes = pass.lanes(group, kTeam), lane = threadIdx.x % lanes;
  const int i = block * (kTeam / lanes) + threadIdx.x / lanes;
  const bool mine_is_one = i < pass.size(group);
  Part mine{};
  if (mine_is_one) mine = pass.part(first + i, lane, lanes);
  mine = sum_of_lanes(mine, min(lanes, 32));
  if (lanes > 32) {
    if (lane % 32 == 0) of_warp[lane / 32] = mine;
    __syncthreads();
    if (lane < kTeam / 32) mine = sum_of_lanes(of_warp[lane], kTeam / 32);
  }
  if (mine_is_one && lane == 0) pass.finish(first + i, mine);
}

}  // namespace pbf::inline PBF_VARIANT
