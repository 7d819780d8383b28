// Finds the candidates near a particle without a branch per candidate: it tests several at once,
// then moves the hits together in their order.
#pragma once

#include <cstdint>

#include "kernels/lanes.h"
#include "lib/program/simd.h"
#ifdef PBF_HAS_AVX
#include <immintrin.h>
#endif

namespace pbf::PBF_VARIANT {

constexpr float kCutoffSquared = 1;  ///< h^2

/// Candidates in ascending order of their index; `count` is a multiple of 16. Padding has NaN for x
/// and is close to no particle.
template <class Real, int D>
struct Candidates {
  static constexpr int block = 16;
  const Real *x, *y, *z;  ///< y: null in two dimensions
  const int* index;
  int count;
};

/// Where the copies of candidates go; y is null in two dimensions.
template <class Real, int D>
struct CandidateCopy {
  Real *x, *y, *z;
  int* index;
};

/// Copies particles b..e-1 of n to adjacent memory; may write up to W - 1 entries more.
template <int W, class Real, int D>
PBF_HD void copy_run_by_lanes(const Vec4<Real>* position, int b, int e, int n,
                              const CandidateCopy<Real, D>& to) {
  int j = b;
  for (; j < e && j + W <= n; j += W) {
    const Vec4<Lanes<Real, W>> from = load(OwnRows<const Vec4<Real>>(position), Adjacent<W>{j});
    from.x.to(to.x + (j - b));
    if constexpr (D == 3) from.y.to(to.y + (j - b));
    from.z.to(to.z + (j - b));
    for (int l = 0; l < W; ++l) to.index[j - b + l] = j + l;
  }
  for (; j < e; ++j) {
    const Vec4<Real>& from = position[j];
    if constexpr (D == 3) to.y[j - b] = from.y;
    to.x[j - b] = from.x, to.z[j - b] = from.z, to.index[j - b] = j;
  }
}
#ifdef PBF_HAS_AVX
template <class Real, int D>
PBF_AVX2 void copy_run_by_avx2(const Vec4<Real>* position, int b, int e, int n,
                               const CandidateCopy<Real, D>& to) {
  copy_run_by_lanes<32 / int(sizeof(Real))>(position, b, e, n, to);
}
#endif
template <class Real, int D>
void copy_run(Simd simd, const Vec4<Real>* position, int b, int e, int n,
              const CandidateCopy<Real, D>& to) {
#ifdef PBF_HAS_AVX
  // Runs are short: wider blocks would be half empty.
  if (simd >= Simd::avx2) return copy_run_by_avx2(position, b, e, n, to);
#endif
  copy_run_by_lanes<16 / int(sizeof(Real))>(position, b, e, n, to);
}

/// Squared distances of candidates k, k + 1, ... from x.
template <class Real, int W, int D>
PBF_HD Lanes<Real, W> squared_distances(const Candidates<Real, D>& c, int k, Vec3<Real> x) {
  using V = Lanes<Real, W>;
  const V dx = V(x.x) - V::at(c.x + k), dz = V(x.z) - V::at(c.z + k);
  if constexpr (D == 2) return dot(Vec2<V>{dx, dz}, Vec2<V>{dx, dz});
  const Vec3<V> away{dx, V(x.y) - V::at(c.y + k), dz};
  return dot(away, away);
}

/// Writes the indices of all candidates but `self` that are closer than h to x, in their order, and
/// returns the end of them; may overwrite up to 16 entries beyond that end.
template <class Real, int D>
int* close_to(const Candidates<Real, D>& c, Vec3<Real> x, int self, int* out) {
  constexpr int block = Candidates<Real, D>::block;
  for (int k = 0; k < c.count; k += block) {
    Real q2[block];
    for (int m = 0; m < block; ++m) {
      Vec<Real, D> d;
      if constexpr (D == 2)
        d = {x.x - c.x[k + m], x.z - c.z[k + m]};
      else
        d = x - Vec3<Real>{c.x[k + m], c.y[k + m], c.z[k + m]};
      q2[m] = dot(d, d);
    }
    for (int m = 0; m < block; ++m) {
      *out = c.index[k + m];
      out += (q2[m] < Real(kCutoffSquared)) & (c.index[k + m] != self);
    }
  }
  return out;
}

#ifdef PBF_HAS_AVX
/// Row b: the positions of the bits set in b, ascending.
struct SetBits {
  std::uint8_t place[256][8];
  constexpr SetBits() : place{} {
    for (int b = 0; b < 256; ++b)
      for (int bit = 0, n = 0; bit < 8; ++bit)
        if (b >> bit & 1) place[b][n++] = std::uint8_t(bit);
  }
};
inline constexpr SetBits kSetBits;

template <class Real, int D>
PBF_AVX2 int* close_to_by_avx2(const Candidates<Real, D>& c, Vec3<Real> x, int self, int* out) {
  const __m256i me = _mm256_set1_epi32(self);
  for (int k = 0; k < c.count; k += 8) {
    int hits;
    if constexpr (sizeof(Real) == 4) {
      const __m256 q2 = squared_distances<Real, 8>(c, k, x).v;
      hits = _mm256_movemask_ps(_mm256_cmp_ps(q2, _mm256_set1_ps(kCutoffSquared), _CMP_LT_OQ));
    } else {
      const __m256d one = _mm256_set1_pd(kCutoffSquared),
                    low = squared_distances<Real, 4>(c, k, x).v,
                    high = squared_distances<Real, 4>(c, k + 4, x).v;
      hits = _mm256_movemask_pd(_mm256_cmp_pd(low, one, _CMP_LT_OQ)) |
             _mm256_movemask_pd(_mm256_cmp_pd(high, one, _CMP_LT_OQ)) << 4;
    }
    const __m256i j = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(c.index + k));
    hits &= ~_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(j, me)));
    const __m256i order = _mm256_cvtepu8_epi32(
        _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSetBits.place[hits])));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32(j, order));
    out += _mm_popcnt_u32(unsigned(hits));
  }
  return out;
}

template <class Real, int D>
PBF_AVX512 int* close_to_by_avx512(const Candidates<Real, D>& c, Vec3<Real> x, int self, int* out) {
  const __m512i me = _mm512_set1_epi32(self);
  for (int k = 0; k < c.count; k += 16) {
    __mmask16 hits;
    if constexpr (sizeof(Real) == 4) {
      const __m512 q2 = squared_distances<Real, 16>(c, k, x).v;
      hits = _mm512_cmp_ps_mask(q2, _mm512_set1_ps(kCutoffSquared), _CMP_LT_OQ);
    } else {
      const __m512d one = _mm512_set1_pd(kCutoffSquared),
                    low = squared_distances<Real, 8>(c, k, x).v,
                    high = squared_distances<Real, 8>(c, k + 8, x).v;
      hits = __mmask16(_mm512_cmp_pd_mask(low, one, _CMP_LT_OQ) |
                       _mm512_cmp_pd_mask(high, one, _CMP_LT_OQ) << 8);
    }
    const __m512i j = _mm512_loadu_si512(c.index + k);
    hits = _mm512_mask_cmpneq_epi32_mask(hits, j, me);
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(hits, j));
    out += _mm_popcnt_u32(hits);
  }
  return out;
}
#endif

template <class Real, int D>
int* close_to(Simd simd, const Candidates<Real, D>& c, Vec3<Real> x, int self, int* out) {
  switch (simd) {
#ifdef PBF_HAS_AVX
    case Simd::avx2:
      return close_to_by_avx2(c, x, self, out);
    case Simd::avx512:
      return close_to_by_avx512(c, x, self, out);
#endif
    default:
      return close_to(c, x, self, out);
  }
}

}  // namespace pbf::PBF_VARIANT
