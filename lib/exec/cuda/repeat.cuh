// A sum that decides on the device whether work is repeated.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>
#include <cub/block/block_reduce.cuh>

#include "kernels/pass_residual.h"
#include "lib/exec/cuda/kernel_start.cuh"

namespace pbf::PBF_VARIANT {

struct RepeatState {
  unsigned long long sum;
  unsigned blocks_done;
  unsigned left;  ///< repetitions that are still allowed
  unsigned go;    ///< the last decision
};

struct Repetition {
  RepeatState* state;  ///< all 0 at first; each decision clears all but `left` and `go`
  unsigned long long* repeats;
  double tolerance;
  unsigned times;
  bool first;  ///< the first decision of a sequence
  bool in_graph;
  cudaGraphConditionalHandle handle;  ///< of the node that repeats, in a graph
};

/// Sums pass(i) of all particles; the block that is done last decides.
template <class Rows, class Pass>
__global__ void __launch_bounds__(kBlock) repeat_kernel(Rows rows, Pass pass, Repetition r) {
  const int n = end_of(rows);
  wait_for_previous();
  unsigned long long sum = 0;
  for (std::int64_t i = blockIdx.x * kBlock + threadIdx.x; i < n;
       i += std::int64_t(gridDim.x) * kBlock)
    sum += pass(int(i));
  using BlockSum = cub::BlockReduce<unsigned long long, kBlock>;
  __shared__ typename BlockSum::TempStorage shared;
  sum = BlockSum(shared).Sum(sum);
  if (threadIdx.x != 0) return;
  RepeatState& s = *r.state;
  atomicAdd(&s.sum, sum);
  __threadfence();
  if (atomicAdd(&s.blocks_done, 1u) != gridDim.x - 1) return;
  __threadfence();
  const unsigned left = r.first ? r.times : s.left;
  const bool go = left > 0 && atomicAdd(&s.sum, 0ull) > residual_limit(r.tolerance, n);
  s.sum = 0;
  s.blocks_done = 0;
  s.left = go ? left - 1 : left;
  s.go = go;
  if (go) ++*r.repeats;
  if (r.in_graph) cudaGraphSetConditional(r.handle, go ? 1 : 0);
}

}  // namespace pbf::PBF_VARIANT
