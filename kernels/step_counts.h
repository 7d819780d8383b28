// What a run counts on the way, one of each.
#pragma once

#include "kernels/hd.h"

namespace pbf::inline PBF_VARIANT {

struct StepCounts {
  unsigned long long fast = 0;    ///< particle-updates above the watched speed (Params)
  unsigned long long rounds = 0;  ///< rounds of sweeps beyond the first of every substep
};

/// Rare: an atomic costs nothing.
PBF_HD void count_one(unsigned long long* count) {
#if defined(__CUDA_ARCH__)
  atomicAdd(count, 1ull);
#elif !defined(__CUDACC__)
  __atomic_fetch_add(count, 1ull, __ATOMIC_RELAXED);
#endif
}

}  // namespace pbf::inline PBF_VARIANT
