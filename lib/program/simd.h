// Selects the vector instructions of the CPU backend when a solver is created, from those of the
// processor, so that one program runs everywhere. All give the same bits.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernels/hd.h"

// Attributes of functions for more than the program's baseline; what they call is inlined.
// PBF_NO_AVX leaves these functions out, as on other processors.
#if defined(__x86_64__) && !defined(PBF_NO_AVX)
#define PBF_HAS_AVX 1
#define PBF_AVX2 __attribute__((target("avx2,popcnt")))
#define PBF_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq,avx512bw,popcnt")))
#endif

namespace pbf::program_module {

/// scalar: one particle at a time. baseline: vectors of 16 bytes, SSE2 on x86-64, elsewhere
/// whatever the compiler generates.
enum class Simd { scalar, baseline, avx2, avx512 };

const char* simd_name(Simd simd);

/// All that this processor and this build support, the widest last.
std::vector<Simd> usable_simd();

/// The widest one, or that named by the environment variable PBF_SIMD (scalar, baseline, avx2,
/// avx512). Throws Error(bad_input) for an unknown name, Error(unavailable) if it is not usable.
Simd chosen_simd();

/// Particles that one vector holds, for scalars of `bytes` bytes, as a power of 2.
constexpr int lane_bits(Simd simd, std::size_t bytes) {
  if (simd == Simd::scalar) return 0;
  return (bytes == 4 ? 2 : 1) + int(simd) - int(Simd::baseline);
}

}  // namespace pbf::program_module
