// Passes whose items several threads share: each makes a part, and parts of whole numbers add up in
// any order (kernels/pass_level_cells.h).
#pragma once

#include <type_traits>

#include "lib/exec/cuda/kernel_start.cuh"

namespace pbf::inline PBF_VARIANT {

/// The sum over `lanes` threads side by side, in the first of them.
template <int lanes, class Part>
__device__ Part sum_of_lanes(Part mine) {
  static_assert(std::is_trivially_copyable_v<Part> && sizeof(Part) % 4 == 0);
  const unsigned mine_first = threadIdx.x % 32 / lanes * lanes;
  const unsigned mask = (lanes == 32 ? ~0u : (1u << lanes % 32) - 1) << mine_first;
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
__global__ void __launch_bounds__(kBlock) shared_kernel(int n, Pass pass) {
  wait_for_previous();
  constexpr int lanes = Pass::lanes;
  const int thread = blockIdx.x * kBlock + threadIdx.x, i = thread / lanes, lane = thread % lanes;
  typename Pass::Part mine{};
  if (i < n) mine = pass.part(i, lane, lanes);
  mine = sum_of_lanes<lanes>(mine);
  if (i < n && lane == 0) pass.finish(i, mine);
}

/// Small steps one after the other, by one block.
constexpr int kTurnBlock = 1024;
template <class Pass>
__global__ void __launch_bounds__(kTurnBlock) in_turn_kernel(const __grid_constant__ Pass pass) {
  wait_for_previous();
  constexpr int lanes = Pass::lanes;
  const int thread = threadIdx.x;
  for (int step = 0; step < pass.steps(); ++step) {
    const int n = pass.size(step);
    if (pass.shared(step)) {
      for (int i = thread / lanes; i < n; i += kTurnBlock / lanes) {
        const auto sum = sum_of_lanes<lanes>(pass.part(step, i, thread % lanes, lanes));
        if (thread % lanes == 0) pass.finish(step, i, sum);
      }
    } else {
      for (int i = thread; i < n; i += kTurnBlock) pass(step, i);
    }
    __syncthreads();
  }
}

}  // namespace pbf::inline PBF_VARIANT
