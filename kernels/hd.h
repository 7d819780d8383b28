// What lets one source compile for the host and, under nvcc, for the device; and more than once
// into one program.
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
// PBF_HD_APART: large, and only for the few particles at an obstacle. PBF_HD_RARE: small, and for
// these few alone: inlined where a call costs every thread registers. Everything else is inlined
// into every pass.

// Everything that holds arithmetic on particles lives in this inline namespace. A second
// compilation under another name (with other floating-point options, say) can then be linked beside
// the first: its types and functions are different ones.
#ifndef PBF_VARIANT
#define PBF_VARIANT plain
#endif

// The variant `pinned` (PBF_PINNED, compiled without contraction) gives the host's bits on the
// device. Otherwise the device takes its fast root and fused products.
#if defined(__CUDA_ARCH__) && !defined(PBF_PINNED)
#define PBF_FAST_DEVICE 1
#endif
