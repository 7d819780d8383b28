// What a run counts on the way, one of each.
#pragma once

#include "kernels/hd.h"

namespace pbf::inline PBF_VARIANT {

struct StepCounts {
  unsigned long long fast = 0;     ///< particle-updates above the watched speed (Params)
  unsigned long long repeats = 0;  ///< repeats of the iterations beyond the first of every substep
  unsigned long long unresolved = 0;  ///< particles times steps (relative_motion.h)
  float way_squared = 0;              ///< h^2, of the longest way of these relative to a neighbour
};

/// Rare: an atomic costs nothing.
PBF_HD void count_one(unsigned long long* count) {
#if defined(__CUDA_ARCH__)
  atomicAdd(count, 1ull);
#elif !defined(__CUDACC__)
  __atomic_fetch_add(count, 1ull, __ATOMIC_RELAXED);
#endif
}

/// *at = max(*at, value) for values that are not negative: their bits are in the order of integers.
PBF_HD void raise_to(float* at, float value) {
#if defined(__CUDA_ARCH__)
  atomicMax(reinterpret_cast<unsigned*>(at), __float_as_uint(value));
#elif !defined(__CUDACC__)
  float now;
  __atomic_load(at, &now, __ATOMIC_RELAXED);
  while (now < value &&
         !__atomic_compare_exchange(at, &now, &value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
#endif
}

}  // namespace pbf::inline PBF_VARIANT
