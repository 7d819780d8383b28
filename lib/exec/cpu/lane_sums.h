// Runs a pass over neighbors for a range of particles, for each set of vector instructions.
#pragma once

#include "kernels/lane_groups.h"
#include "lib/program/simd.h"

namespace pbf::PBF_VARIANT {

/// Always inlined, so that it is compiled for the instructions of the function that calls it.
template <int bytes, class Pass>
PBF_HD void sum_by_lanes(const Pass& pass, int first, int last) {
  using Real = std::remove_cv_t<decltype(pass.p.dt)>;
  constexpr int width = bytes / int(sizeof(Real));
  for (int i = first; i < last; i += width) sum_over_neighbors_by_lanes<Real, width>(pass, i, last);
}
#ifdef PBF_HAS_AVX
template <class Pass>
PBF_AVX2 void sum_by_avx2(const Pass& pass, int first, int last) {
  sum_by_lanes<32>(pass, first, last);
}
template <class Pass>
PBF_AVX512 void sum_by_avx512(const Pass& pass, int first, int last) {
  sum_by_lanes<64>(pass, first, last);
}
#endif

/// The pass for the particles first..last-1; `first` begins a group of the lists.
template <class Pass>
void sum_over_neighbors(Simd simd, const Pass& pass, int first, int last) {
  switch (simd) {
    case Simd::scalar:
      for (int i = first; i < last; ++i) sum_over_neighbors(pass, i);
      return;
#ifdef PBF_HAS_AVX
    case Simd::avx2:
      return sum_by_avx2(pass, first, last);
    case Simd::avx512:
      return sum_by_avx512(pass, first, last);
#endif
    default:
      return sum_by_lanes<16>(pass, first, last);
  }
}

}  // namespace pbf::PBF_VARIANT
