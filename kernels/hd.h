// What lets one source compile for the host and, under nvcc, for the device.
#pragma once

#if defined(__CUDACC__)
#define PBF_HD __host__ __device__ __forceinline__
#else
#define PBF_HD inline __attribute__((always_inline))
#endif
