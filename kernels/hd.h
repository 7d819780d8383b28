// Macros with which one source compiles for the host, under nvcc also for the device, and several
// times into one program.
#pragma once

#if defined(__CUDACC__)
#define PBF_HD __host__ __device__ __forceinline__
#define PBF_HD_APART __host__ __device__ __noinline__
#define PBF_HD_RARE PBF_HD
#else
#define PBF_HD inline __attribute__((always_inline))
#define PBF_HD_APART __attribute__((noinline))
#define PBF_HD_RARE PBF_HD_APART
#endif
// PBF_HD_APART: large functions for the few particles at an obstacle. PBF_HD_RARE: small functions
// for these particles, inlined on the device, where a call would cost every thread registers. All
// other functions are inlined into every pass.

// The variant `pinned` (PBF_PINNED, compiled without contraction) gives the host's bits on the
// device. Otherwise the device uses its fast root and fused products.
#if defined(__CUDA_ARCH__) && !defined(PBF_PINNED)
#define PBF_FAST_DEVICE 1
#endif
