// Positions in 8 bytes, for a neighbor sum in float and three dimensions that needs nothing else of
// a neighbor: a gather of 8 bytes costs a GPU half as much as one of 16 (PERFORMANCE.md).
//
// Only differences between neighbors matter, so x is stored modulo 4 h, as a place on a ring of
// 2^32 steps. Differences as whole numbers are right for pairs less than 2 h apart. A row has 21
// bits for each axis, in steps of 1.9e-6 h: as fine as a float between 16 and 32 h.
//
//   xz:  21 bits of x, then the upper 11 bits of z
//   yz:  21 bits of y, then the lower 10 bits of z, then 1; 0 there: the row pads lists
// Rounding makes up for the bits that follow in a word: a word as a whole is the number nearest to
// x or y, so it is not masked.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "kernels/vec3.h"

namespace pbf {

struct alignas(8) PackedPosition {
  std::uint32_t xz, yz;
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

PBF_HD std::uint32_t bits_of(float x) {
#if defined(__CUDA_ARCH__)
  return __float_as_uint(x);
#else
  std::uint32_t b;
  memcpy(&b, &x, sizeof b);
  return b;
#endif
}
PBF_HD float float_of(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return __uint_as_float(bits);
#else
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
#endif
}

/// Steps of the ring in h.
constexpr float kRingSteps = 0x1p30f, kRingStep = 0x1p-30f;

/// x as a place on the ring. |x| below 1e9.
PBF_HD std::uint32_t on_ring(float x) {
  return std::uint32_t(static_cast<long long>(x * kRingSteps));
}
/// a - b on the ring, in its steps.
PBF_HD float ring_difference(std::uint32_t a, std::uint32_t b) {
  return float(std::int32_t(a - b));
}

PBF_HD PackedPosition packed_position(Vec3<float> x) {
  const std::uint32_t half = 1u << 10, z = (on_ring(x.z) + half) >> 11;
  const std::uint32_t above = z >> 10, below = (z & 1023) << 1 | 1;
  return {((on_ring(x.x) - above + half) & ~2047u) | above,
          ((on_ring(x.y) - below + half) & ~2047u) | below};
}
/// z on the ring, and half a step more.
PBF_HD std::uint32_t unpacked_z(PackedPosition p) {
#if defined(__CUDA_ARCH__)
  return __funnelshift_l(p.yz << 21, p.xz, 21);
#else
  return p.xz << 21 | p.yz << 21 >> 11;
#endif
}
/// x_a - x_b, in steps of the ring.
PBF_HD Vec3<float> packed_steps(PackedPosition a, PackedPosition b) {
  return {ring_difference(a.xz, b.xz), ring_difference(a.yz, b.yz),
          ring_difference(unpacked_z(a), unpacked_z(b))};
}
PBF_HD bool pads_lists(PackedPosition p) { return (p.yz & 1) == 0; }

PBF_HD PackedPosition load(const PackedPosition* a, int i) {
#if defined(__CUDA_ARCH__)
  const uint2 p = __ldg(reinterpret_cast<const uint2*>(a) + i);
  return {p.x, p.y};
#else
  return a[i];
#endif
}

/// Positions that a pass writes and, where `packed` is not null, also their packed rows.
struct PackingRows : OwnRows<Vec4<float>> {
  PackedPosition* packed = nullptr;
  PackingRows() = default;
  PBF_HD PackingRows(OwnRows<Vec4<float>> rows) : OwnRows<Vec4<float>>(rows) {}
};
PBF_HD void set_row(PackingRows a, int i, const Vec4<float>& value) {
  a[i] = value;
  if (a.packed) a.packed[i] = packed_position(xyz(value));
}
template <class Real>
using MovedRows = std::conditional_t<std::is_same_v<Real, float>, PackingRows, OwnRows<Vec4<Real>>>;

}  // namespace pbf::PBF_VARIANT
