// Position, velocity and density of a particle in the 16 bytes of one row, for a neighbor sum in
// float and three dimensions that needs all of them. A gather of a row costs a GPU the same for
// each 16 bytes, so such a sum takes half the time that it takes with two rows (PERFORMANCE.md).
//
// Only differences between neighbors matter, so x and dt v are stored modulo 4 h, as places on a
// ring of 2^32 steps, whose differences as whole numbers are right for pairs less than 2 h apart:
// x with 16 bits (steps of 6e-5 h), dt v with 21 bits (2e-6 h), 1/density with 17 bits (1/8192,
// below 16). A sum over 30 neighbors is then right to about 5e-5 of itself and 1e-6 h.
//
//   word k of 3:  16 bits of x_k, then the upper 16 bits of (dt v)_k
//   word 3:       the lower 5 bits of (dt v)_0, (dt v)_1, (dt v)_2, then 17 bits of 1/density;
//                 0 there: the row pads lists and adds nothing
// Rounding makes up for the bits that follow in a word: a word as a whole is the number nearest to
// x_k, and so is what unpacked_way() returns, so neither of them is masked.
#pragma once

#include "kernels/packed_position.h"

namespace pbf::PBF_VARIANT {

constexpr float kDensitySteps = 8192;  ///< 1/density in steps of its inverse
constexpr std::uint32_t kDensityMask = (1u << 17) - 1;

/// The row. way: dt v. inverse_density: of rho0.
PBF_HD Vec4<float> packed_motion(Vec3<float> x, Vec3<float> way, float inverse_density) {
  const float d = mul_add(kDensitySteps, inverse_density, 0.5f);
  std::uint32_t last = std::uint32_t(min2(max2(d, 1.f), float(kDensityMask))), high[3];
  const float place[3] = {x.x, x.y, x.z}, ways[3] = {way.x, way.y, way.z};
  for (int k = 2; k >= 0; --k) {
    // The 11 bits that follow those of the way in unpacked_way().
    const std::uint32_t behind = last << (5 * k + 5) >> 21;
    const std::uint32_t w = (on_ring(ways[k]) - behind + (1u << 10)) >> 11;
    last |= (w & 31) << (27 - 5 * k);
    high[k] = w >> 5;
  }
  float word[3];
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t p = (on_ring(place[k]) - high[k] + (1u << 15)) >> 16;
    word[k] = float_of(p << 16 | high[k]);
  }
  return {word[0], word[1], word[2], float_of(last)};
}

/// dt v on the ring, along axis k; word: number k of the row, last: number 3.
template <int k>
PBF_HD std::uint32_t unpacked_way(float word, float last) {
  const std::uint32_t low = bits_of(last) << 5 * k;
#if defined(__CUDA_ARCH__)
  return __funnelshift_l(low, bits_of(word), 16);
#else
  return bits_of(word) << 16 | low >> 16;
#endif
}
PBF_HD bool pads_motion(const Vec4<float>& row) { return (bits_of(row.w) & kDensityMask) == 0; }
/// x_a - x_b, h.
PBF_HD Vec3<float> packed_distance(const Vec4<float>& a, const Vec4<float>& b) {
  return kRingStep * Vec3<float>{ring_difference(bits_of(a.x), bits_of(b.x)),
                                 ring_difference(bits_of(a.y), bits_of(b.y)),
                                 ring_difference(bits_of(a.z), bits_of(b.z))};
}
/// dt (v_a - v_b), in steps of the ring.
PBF_HD Vec3<float> packed_way_steps(const Vec4<float>& a, const Vec4<float>& b) {
  return {ring_difference(unpacked_way<0>(a.x, a.w), unpacked_way<0>(b.x, b.w)),
          ring_difference(unpacked_way<1>(a.y, a.w), unpacked_way<1>(b.y, b.w)),
          ring_difference(unpacked_way<2>(a.z, a.w), unpacked_way<2>(b.z, b.w))};
}
/// 1/density_a + 1/density_b; 0 if b pads lists.
PBF_HD float packed_inverse_densities(const Vec4<float>& a, const Vec4<float>& b) {
  // 16 + 1/density is a float whose last bits are those of the row.
  const std::uint32_t sixteen = 0x41800000u, of_b = bits_of(b.w) & kDensityMask;
  const float a16 = float_of(sixteen | (bits_of(a.w) & kDensityMask) << 6);
  const float b16 = float_of(sixteen | of_b << 6);
  return of_b ? b16 + (a16 - 32.f) : 0.f;
}

/// Writes the rows of all particles.
struct PackMotionPass {
  float dt;
  OwnRows<const Vec4<float>> position;  ///< w = 1/density
  OwnRows<const Vec4<float>> velocity;  ///< h/s
  OwnRows<Vec4<float>> motion;          ///< out
  PBF_HD void operator()(int i) const {
    const Vec4<float> x = position[i];
    set_row(motion, i, packed_motion(xyz(x), dt * xyz(velocity[i]), x.w));
  }
};

}  // namespace pbf::PBF_VARIANT
