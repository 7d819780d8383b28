// The launch of every kernel, and its first statement.
#pragma once

#include <cuda_runtime.h>

#include <cstdint>

#include "kernels/hd.h"
#include "lib/exec/cuda/check.h"

namespace pbf::inline PBF_VARIANT {

constexpr int kBlock = 128;

/// First statement of every kernel. A kernel is set up while the previous one ends, and waits here
/// until that one is done (programmatic dependent launch, from sm_90 on). An explicit early trigger
/// is slower: its blocks would occupy places that blocks of the previous kernel need
/// (kernels/PERFORMANCE.md).
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
