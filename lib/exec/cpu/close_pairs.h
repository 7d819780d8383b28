// Finds the particles near another one without a branch per candidate: it tests several at once,
// then moves the hits together in their order.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/lanes.h"
#include "lib/program/simd.h"
#ifdef PBF_HAS_AVX
#include <immintrin.h>
#endif

namespace pbf::PBF_VARIANT {

constexpr float kCutoffSquared = 1;  ///< h^2

/// The coordinates of all particles, in the order of their rows. Some more rows can be read.
template <class Real>
struct Columns {
  static constexpr int room = 16;  ///< how many more
  Real *x, *y, *z;                 ///< y: null in two dimensions
};

/// Copies the positions of rows b ... e - 1.
template <int W, class Real>
PBF_HD void fill_by_lanes(const Vec4<Real>* position, int b, int e, const Columns<Real>& to) {
  int j = b;
  for (; j + W <= e; j += W) {
    const Vec4<Lanes<Real, W>> from = load(OwnRows<const Vec4<Real>>(position), Adjacent<W>{j});
    from.x.to(to.x + j);
    if (to.y) from.y.to(to.y + j);
    from.z.to(to.z + j);
  }
  for (; j < e; ++j) {
    to.x[j] = position[j].x, to.z[j] = position[j].z;
    if (to.y) to.y[j] = position[j].y;
  }
}
#ifdef PBF_HAS_AVX
template <class Real>
PBF_AVX2 void fill_by_avx2(const Vec4<Real>* position, int b, int e, const Columns<Real>& to) {
  fill_by_lanes<32 / int(sizeof(Real))>(position, b, e, to);
}
#endif
template <class Real>
void fill([[maybe_unused]] Simd simd, const Vec4<Real>* position, int b, int e,
          const Columns<Real>& to) {
#ifdef PBF_HAS_AVX
  if (simd >= Simd::avx2) return fill_by_avx2(position, b, e, to);
#endif
  fill_by_lanes<16 / int(sizeof(Real))>(position, b, e, to);
}

/// rows: bit k says whether row first + k is one of them; without AVX2 and AVX-512, their number.
struct Block {
  int first;
  unsigned rows;
};
/// The rows that may be close to a particle, in ascending order, as blocks: the particles of a half
/// cell have them in common, and the loop over them has no other loop in it.
using Blocks = std::vector<Block>;
/// Adds rows begin ... end - 1, which are not none. Vectors begin at multiples of their width, so
/// that no load takes two lines of the cache.
inline void add_rows(Simd simd, int begin, int end, Blocks& blocks) {
  if (simd < Simd::avx2) return blocks.push_back({begin, unsigned(end - begin)});
  const int width = simd == Simd::avx512 ? 16 : 8;
  for (int first = begin & -width; first < end; first += width) {
    const unsigned before = first < begin ? (1u << (begin - first)) - 1 : 0u;
    const unsigned behind = end - first < width ? ~0u << (end - first) : 0u;
    blocks.push_back({first, ~(before | behind)});
  }
}

/// Squared distances of rows k, k + 1, ... from x.
template <class Real, int W, int D>
PBF_HD Lanes<Real, W> squared_distances(const Columns<Real>& c, int k, Vec3<Real> x) {
  using V = Lanes<Real, W>;
  const V dx = V(x.x) - V::at(c.x + k), dz = V(x.z) - V::at(c.z + k);
  if constexpr (D == 2) return dot(Vec2<V>{dx, dz}, Vec2<V>{dx, dz});
  const Vec3<V> away{dx, V(x.y) - V::at(c.y + k), dz};
  return dot(away, away);
}

/// Writes those rows of the blocks but `self` that are closer than h to x, in their order, and
/// returns the end of them; may overwrite up to 16 entries beyond that end.
template <class Real, int D>
int* close_to(const Columns<Real>& c, const Blocks& blocks, Vec3<Real> x, int self, int* out) {
  constexpr int width = 16 / int(sizeof(Real));
  for (const Block& b : blocks) {
    const int end = b.first + int(b.rows);
    for (int j = b.first; j < end; j += width) {
      Real q2[width];
      squared_distances<Real, width, D>(c, j, x).to(q2);
      for (int m = 0; m < width; ++m) {
        *out = j + m;
        out += (q2[m] < Real(kCutoffSquared)) & (j + m != self) & (j + m < end);
      }
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
PBF_AVX2 int* close_to_by_avx2(const Columns<Real>& c, const Blocks& blocks, Vec3<Real> x, int self,
                               int* out) {
  const __m256i me = _mm256_set1_epi32(self), upward = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  for (const auto& [k, rows] : blocks) {
    int hits;
    if constexpr (sizeof(Real) == 4) {
      const __m256 q2 = squared_distances<Real, 8, D>(c, k, x).v;
      hits = _mm256_movemask_ps(_mm256_cmp_ps(q2, _mm256_set1_ps(kCutoffSquared), _CMP_LT_OQ));
    } else {
      const __m256d one = _mm256_set1_pd(kCutoffSquared),
                    low = squared_distances<Real, 4, D>(c, k, x).v,
                    high = squared_distances<Real, 4, D>(c, k + 4, x).v;
      hits = _mm256_movemask_pd(_mm256_cmp_pd(low, one, _CMP_LT_OQ)) |
             _mm256_movemask_pd(_mm256_cmp_pd(high, one, _CMP_LT_OQ)) << 4;
    }
    hits &= int(rows);
    const __m256i j = _mm256_add_epi32(_mm256_set1_epi32(k), upward);
    hits &= ~_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(j, me)));
    const __m256i order = _mm256_cvtepu8_epi32(
        _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSetBits.place[hits])));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), _mm256_permutevar8x32_epi32(j, order));
    out += _mm_popcnt_u32(unsigned(hits));
  }
  return out;
}

template <class Real, int D>
PBF_AVX512 int* close_to_by_avx512(const Columns<Real>& c, const Blocks& blocks, Vec3<Real> x,
                                   int self, int* out) {
  const __m512i me = _mm512_set1_epi32(self),
                upward = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  for (const auto& [k, rows] : blocks) {
    __mmask16 hits;
    if constexpr (sizeof(Real) == 4) {
      const __m512 q2 = squared_distances<Real, 16, D>(c, k, x).v;
      hits = _mm512_cmp_ps_mask(q2, _mm512_set1_ps(kCutoffSquared), _CMP_LT_OQ);
    } else {
      const __m512d one = _mm512_set1_pd(kCutoffSquared),
                    low = squared_distances<Real, 8, D>(c, k, x).v,
                    high = squared_distances<Real, 8, D>(c, k + 8, x).v;
      hits = __mmask16(_mm512_cmp_pd_mask(low, one, _CMP_LT_OQ) |
                       _mm512_cmp_pd_mask(high, one, _CMP_LT_OQ) << 8);
    }
    hits = __mmask16(hits & rows);
    const __m512i j = _mm512_add_epi32(_mm512_set1_epi32(k), upward);
    hits = _mm512_mask_cmpneq_epi32_mask(hits, j, me);
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(hits, j));
    out += _mm_popcnt_u32(hits);
  }
  return out;
}
#endif

template <int D, class Real>
int* close_to(Simd simd, const Columns<Real>& c, const Blocks& blocks, Vec3<Real> x, int self,
              int* out) {
  switch (simd) {
#ifdef PBF_HAS_AVX
    case Simd::avx2:
      return close_to_by_avx2<Real, D>(c, blocks, x, self, out);
    case Simd::avx512:
      return close_to_by_avx512<Real, D>(c, blocks, x, self, out);
#endif
    default:
      return close_to<Real, D>(c, blocks, x, self, out);
  }
}

}  // namespace pbf::PBF_VARIANT
