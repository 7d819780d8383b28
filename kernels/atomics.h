// Atomic sums, counts and maxima, whose results do not depend on the order of the threads.
#pragma once

#include <cstdint>

#include "kernels/hd.h"

namespace pbf::PBF_VARIANT {

PBF_HD void add_whole(std::int64_t* sum, std::int64_t term) {
#if defined(__CUDA_ARCH__)
  atomicAdd(reinterpret_cast<unsigned long long*>(sum), static_cast<unsigned long long>(term));
#elif !defined(__CUDACC__)
  __atomic_fetch_add(sum, term, __ATOMIC_RELAXED);
#endif
}

/// On a device, if all threads of a warp that are here have one `place`: the sum of their terms for
/// the first of them, 0 for the others. Else the term. What is then added to the places is the
/// same. Many threads that add to one number wait for each other. term: below 2^57.
PBF_HD std::int64_t sum_of_warp([[maybe_unused]] const void* place, std::int64_t term) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  const unsigned here = __activemask();
  int same = 0;
  __match_all_sync(here, reinterpret_cast<unsigned long long>(place), &same);
  if (!same) return term;
  // In parts, of which 32 fit into 32 bits.
  constexpr int bits = 26, mask = (1 << bits) - 1;
  const std::int64_t low = __reduce_add_sync(here, unsigned(term & mask)),
                     middle = __reduce_add_sync(here, unsigned(term >> bits & mask)),
                     high = __reduce_add_sync(here, int(term >> 2 * bits));
  const bool first = (here & ((1u << threadIdx.x % 32) - 1)) == 0;
  return first ? (high << 2 * bits) + (middle << bits) + low : 0;
#elif defined(__CUDA_ARCH__)  // full warps alone
  constexpr unsigned all = 0xffffffffu;
  if (__activemask() != all) return term;
  int same = 0;
  __match_all_sync(all, reinterpret_cast<unsigned long long>(place), &same);
  if (!same) return term;
  for (int k = 16; k > 0; k /= 2) term += __shfl_down_sync(all, term, k);
  return threadIdx.x % 32 == 0 ? term : 0;
#else
  return term;
#endif
}

PBF_HD void count_one(unsigned long long* count) {
#if defined(__CUDA_ARCH__)
  atomicAdd(count, 1ull);
#elif !defined(__CUDACC__)
  __atomic_fetch_add(count, 1ull, __ATOMIC_RELAXED);
#endif
}

/// *at = max(*at, value) for non-negative values, whose bits compare like integers.
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

/// Reserves and returns the next free place; *count places were taken before. All threads of a warp
/// that call it together have the same count.
PBF_HD int take_place(int* count) {
#if defined(__CUDA_ARCH__)
  // One atomic operation for all active threads of the warp.
  const unsigned together = __activemask();
  const int lane = int(threadIdx.x % 32), first = __ffs(int(together)) - 1;
  int begin = 0;
  if (lane == first) begin = atomicAdd(count, __popc(together));
  return __shfl_sync(together, begin, first) + __popc(together & ((1u << lane) - 1));
#elif !defined(__CUDACC__)
  return __atomic_fetch_add(count, 1, __ATOMIC_RELAXED);
#else
  return 0;
#endif
}
/// The same for counts of which each thread may have another.
PBF_HD int take_place_of(int* count) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(count, 1);
#else
  return take_place(count);
#endif
}

}  // namespace pbf::PBF_VARIANT
