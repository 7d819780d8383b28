// The launch of every kernel, and its first statement.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "kernels/hd.h"
#include "kernels/row_state.h"
#include "lib/exec/cuda/check.h"

namespace pbf::inline PBF_VARIANT {

constexpr int kBlock = 128;

/// The number of particles, as the host or the device knows it: at most, and in a kernel. A kernel
/// asks before wait_for_previous(), which hides the load: see CudaExec::rows_changed().
inline int most(int n) { return n; }
inline int most(const CountedRows& rows) { return rows.most; }
__device__ __forceinline__ int count_of(int n) { return n; }
__device__ __forceinline__ int count_of(const CountedRows& rows) { return int(rows.state->rows); }

/// First statement of every kernel, but for count_of(). A kernel is set up while the previous one
/// ends, and waits here until that one is done (programmatic dependent launch, from sm_90 on). An
/// explicit early trigger is slower: its blocks would occupy places that blocks of the previous
/// kernel need (kernels/PERFORMANCE.md).
__device__ __forceinline__ void wait_for_previous() {
#if __CUDA_ARCH__ >= 900
  cudaGridDependencySynchronize();
#endif
}

/// Launches enough blocks of `block` threads for `threads` > 0. overlap: with programmatic
/// dependent launch, which hides most of the time between two kernels.
template <class... P, class... A>
void start_kernel(cudaStream_t stream, bool overlap, void (*kernel)(P...), int threads, int block,
                  std::size_t shared, const A&... args) {
  cudaLaunchConfig_t config{};
  config.gridDim = dim3(unsigned((std::int64_t(threads) + block - 1) / block));
  config.blockDim = dim3(unsigned(block));
  config.dynamicSmemBytes = shared;
  config.stream = stream;
  cudaLaunchAttribute dependent{};
  dependent.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  dependent.val.programmaticStreamSerializationAllowed = 1;
  config.attrs = &dependent;
  config.numAttrs = overlap ? 1 : 0;
  PBF_CUDA_CHECK(cudaLaunchKernelEx(&config, kernel, P(args)...));
}

}  // namespace pbf::inline PBF_VARIANT
