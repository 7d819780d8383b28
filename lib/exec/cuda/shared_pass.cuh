// Passes whose items are shared by several threads: each computes a part. Parts are integers, so
// they can be added in any order (kernels/pass_shapes.h).
#pragma once

#include <cub/block/block_reduce.cuh>
#include <cub/warp/warp_reduce.cuh>
#include <utility>

#include "lib/exec/cuda/kernel_start.cuh"

namespace pbf::PBF_VARIANT {

struct AddParts {
  template <class Part>
  __device__ Part operator()(Part a, const Part& b) const {
    a += b;
    return a;
  }
};

/// The sum over `lanes` <= 32 adjacent threads, in the first of them.
template <int lanes, class Part>
__device__ __forceinline__ Part sum_of_lanes(const Part& mine) {
  using LaneSum = cub::WarpReduce<Part, lanes>;
  __shared__ typename LaneSum::TempStorage shared;
  static_assert(sizeof shared == 1, "shuffles need no memory: one for all groups of lanes");
  return LaneSum(shared).Reduce(mine, AddParts{});
}

template <class Pass>
__global__ void __launch_bounds__(kBlock) shared_kernel(int n, const __grid_constant__ Pass pass) {
  wait_for_previous();
  constexpr int lanes = Pass::lanes;
  const int thread = blockIdx.x * kBlock + threadIdx.x, i = thread / lanes, lane = thread % lanes;
  typename Pass::Part mine{};
  if (i < n) mine = pass.part(i, lane, lanes);
  mine = sum_of_lanes<lanes>(mine);
  if (i < n && lane == 0) pass.finish(i, mine);
}

/// One block per brick (kernels/levels.h).
template <class Pass>
constexpr int kBrickBlock = Pass::brick_cells* Pass::lanes;
/// At most 64 registers per thread, so that a block of 512 threads leaves room for another.
template <class Pass>
__global__ void __launch_bounds__(kBrickBlock<Pass>, 1024 / kBrickBlock<Pass>)
    brick_kernel(int first, const __grid_constant__ Pass pass) {
  __shared__ std::int64_t found[Pass::brick_cells];
  begin_pass<Pass>();
  const GridPlace brick = pass.brick(first + blockIdx.x);
  const int k = threadIdx.x / Pass::lanes, lane = threadIdx.x % Pass::lanes;
  const GridPlace c = pass.cell(brick, k);
  const bool there = pass.grid.has(c);
  typename Pass::Part mine{};
  if (there) mine = pass.part(c, lane, Pass::lanes);
  mine = sum_of_lanes<Pass::lanes>(mine);
  if (lane == 0) found[k] = there ? pass.finish(c, mine) : 0;
  __syncthreads();
  constexpr int warps = kBrickBlock<Pass> / 32;
  for (int which = threadIdx.x / 32; which < Pass::brick_corners; which += warps) {
    decltype(pass.share(0, 0, 0)) sum{};
    for (int j = threadIdx.x % 32; j < Pass::brick_cells; j += 32)
      sum += pass.share(which, j, found[j]);
    sum = sum_of_lanes<32>(sum);
    if (threadIdx.x % 32 == 0) pass.finish_corner(brick, which, sum);
  }
}

/// The sum over a block of `threads`, in its first thread.
template <int threads, class Part>
__device__ __forceinline__ Part sum_of_block(const Part& mine) {
  using BlockSum = cub::BlockReduce<Part, threads>;
  __shared__ typename BlockSum::TempStorage shared;
  return BlockSum(shared).Reduce(mine, AddParts{});
}

/// sum_of_lanes() for a number of lanes known at run time: 1, or one of `widths`.
template <class Part, int... widths>
__device__ __forceinline__ void sum_of_some_lanes(Part& mine, int lanes,
                                                  std::integer_sequence<int, widths...>) {
  ((lanes == widths ? void(mine = sum_of_lanes<widths>(mine)) : void()), ...);
}

/// Groups of items, each shared by a power of two up to 32 threads or by a block. All items of a
/// block are of one group.
constexpr int kTeam = 256;
template <class Pass>
__host__ __device__ int team_blocks(const Pass& pass, int group) {
  return int((std::int64_t(pass.size(group)) * pass.lanes(group, kTeam) + kTeam - 1) / kTeam);
}
template <class Pass>
__global__ void __launch_bounds__(kTeam, 1024 / kTeam)
    team_kernel(const __grid_constant__ Pass pass) {
  using Part = typename Pass::Part;
  int group = 0, first = 0, block = blockIdx.x;
  for (int b; block >= (b = team_blocks(pass, group)); block -= b) first += pass.size(group++);
  const int lanes = pass.lanes(group, kTeam), lane = threadIdx.x % lanes;
  const int i = block * (kTeam / lanes) + threadIdx.x / lanes;
  const bool mine_is_one = i < pass.size(group);
  begin_pass<Pass>([&] {
    if constexpr (requires { &Pass::is_off; }) return !mine_is_one || pass.is_off(first + i);
    return false;
  });
  Part mine{};
  if (mine_is_one) mine = pass.part(first + i, lane, lanes);
  if (lanes == kTeam)
    mine = sum_of_block<kTeam>(mine);
  else
    sum_of_some_lanes(mine, lanes, std::integer_sequence<int, 2, 4, 8, 16, 32>{});
  if (mine_is_one && lane == 0) pass.finish(first + i, mine);
}

}  // namespace pbf::PBF_VARIANT
