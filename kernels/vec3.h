// Small vectors. Only + - * / and sqrt: each is rounded the same way on every backend.
#pragma once

#include <math.h>

#include <cstddef>
#include <type_traits>

#include "kernels/rows.h"

namespace pbf::PBF_VARIANT {

template <class Real>
struct Vec3 {
  Real x{}, y{}, z{};
};

/// A vector of the x-z plane, for scenes of two dimensions.
template <class Real>
struct Vec2 {
  Real x{}, z{};
};

/// The vector of pair loops, with as many components as the scene has dimensions.
template <class Real, int dimensions>
using Vec = std::conditional_t<dimensions == 2, Vec2<Real>, Vec3<Real>>;

/// Four scalars moved by one 16- or 32-byte access; w is documented where it is used.
template <class Real>
struct alignas(4 * sizeof(Real)) Vec4 {
  Real x, y, z, w;
};

// clang-format off
template <class R> PBF_HD Vec3<R> operator+(Vec3<R> a, Vec3<R> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class R> PBF_HD Vec3<R> operator-(Vec3<R> a, Vec3<R> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class R> PBF_HD Vec3<R> operator*(R s, Vec3<R> a) { return {s * a.x, s * a.y, s * a.z}; }
template <class R> PBF_HD R dot(Vec3<R> a, Vec3<R> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class R> PBF_HD Vec3<R> cross(Vec3<R> a, Vec3<R> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class R> PBF_HD Vec2<R> operator+(Vec2<R> a, Vec2<R> b) { return {a.x + b.x, a.z + b.z}; }
template <class R> PBF_HD Vec2<R> operator-(Vec2<R> a, Vec2<R> b) { return {a.x - b.x, a.z - b.z}; }
template <class R> PBF_HD Vec2<R> operator*(R s, Vec2<R> a) { return {s * a.x, s * a.z}; }
template <class R> PBF_HD R dot(Vec2<R> a, Vec2<R> b) { return a.x * b.x + a.z * b.z; }
template <class R> PBF_HD R cross(Vec2<R> a, Vec2<R> b) { return a.z * b.x - a.x * b.z; }  // its y
template <class R> PBF_HD Vec3<R> xyz(const Vec4<R>& a) { return {a.x, a.y, a.z}; }
template <class R> PBF_HD Vec4<R> with_w(Vec3<R> a, R w) { return {a.x, a.y, a.z, w}; }
template <class R> PBF_HD R max2(R a, R b) { return a > b ? a : b; }
template <class R> PBF_HD R min2(R a, R b) { return a < b ? a : b; }
// clang-format on

/// As an array of states and tables, whose types are the same on all backends.
PBF_HD Vec3<double> vec(const double (&a)[3]) { return {a[0], a[1], a[2]}; }
PBF_HD void put(double (&to)[3], Vec3<double> a) { to[0] = a.x, to[1] = a.y, to[2] = a.z; }

/// The components that a pair loop needs.
template <int dimensions, class R>
PBF_HD Vec<R, dimensions> point(const Vec4<R>& a) {
  if constexpr (dimensions == 2)
    return {a.x, a.z};
  else
    return xyz(a);
}
/// The same vector with three components; a number (a cross product in the plane) becomes y.
template <class R>
PBF_HD Vec3<R> in_space(Vec2<R> a) {
  return {a.x, R(0), a.z};
}
template <class R>
PBF_HD Vec3<R> in_space(Vec3<R> a) {
  return a;
}
template <class R>
PBF_HD Vec3<R> in_space(R y) {
  return {R(0), y, R(0)};
}

// Conditions of formulas that are also for several particles at once, for which kernels/lanes.h and
// lane_groups.h have the same functions. For one particle, a condition is a bool.
/// a where `c` holds, b elsewhere.
template <class Real>
requires std::is_floating_point_v<Real> PBF_HD Real choose(bool c, Real a, Real b) {
  return c ? a : b;
}
template <class Condition, class R>
PBF_HD Vec3<R> choose(const Condition& c, Vec3<R> a, Vec3<R> b) {
  return {choose(c, a.x, b.x), choose(c, a.y, b.y), choose(c, a.z, b.z)};
}
PBF_HD bool holds_everywhere(bool c) { return c; }
PBF_HD bool holds_somewhere(bool c) { return c; }
/// f(row) for each row where the condition holds.
template <class F>
PBF_HD void for_rows_where(bool c, int row, F&& f) {
  if (c) f(row);
}

PBF_HD float square_root(float x) { return sqrtf(x); }
PBF_HD double square_root(double x) { return sqrt(x); }

/// a b + c for values that two kernels must compute with the same bits: the device's compiler may
/// fuse a product and a sum in one kernel but not in the other. Elsewhere rounded twice.
template <class Real>
PBF_HD Real mul_add(Real a, Real b, Real c) {
#if defined(PBF_FAST_DEVICE)
  if constexpr (sizeof(Real) == 4)
    return __fmaf_rn(a, b, c);
  else
    return __fma_rn(a, b, c);
#else
  return a * b + c;
#endif
}
template <class Real>
PBF_HD Vec3<Real> mul_add(Real a, Vec3<Real> b, Vec3<Real> c) {
  return {mul_add(a, b.x, c.x), mul_add(a, b.y, c.y), mul_add(a, b.z, c.z)};
}
template <class Real>
PBF_HD Vec2<Real> mul_add(Real a, Vec2<Real> b, Vec2<Real> c) {
  return {mul_add(a, b.x, c.x), mul_add(a, b.z, c.z)};
}
/// |d|^2 in the same way.
template <class Real>
PBF_HD Real square_by_mul_add(Vec3<Real> d) {
  return mul_add(d.z, d.z, mul_add(d.y, d.y, d.x * d.x));
}
template <class Real>
PBF_HD Real square_by_mul_add(Vec2<Real> d) {
  return mul_add(d.z, d.z, d.x * d.x);
}

/// q and 1/q from q^2 for a pair loop; q^2 below 1e-30 counts as 1e-30, so that a coincident pair
/// gives q = 1e-15 and, with its zero distance vector, a zero gradient instead of 0/0. Fast device
/// code uses the hardware's reciprocal root (2 ulp in float) and one multiplication.
template <class Real>
struct Root {
  Real q, inverse;
};
template <class Real>
PBF_HD Root<Real> root_of(Real q_squared) {
  q_squared = max2(q_squared, Real(1e-30));
#if defined(PBF_FAST_DEVICE)
  Real inverse;
  if constexpr (sizeof(Real) ==
                4)  // never denormal here: one instruction, without the check for it
    asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(q_squared));
  else
    inverse = rsqrt(q_squared);
  return {q_squared * inverse, inverse};
#else
  const Real q = square_root(q_squared);
  return {q, Real(1) / q};
#endif
}

/// a[i] of an array that the current pass does not write: on the device through the read-only path,
/// 16 bytes at a time.
template <class Real>
PBF_HD Vec4<Real> load(const Vec4<Real>* a, int i) {
#if defined(__CUDA_ARCH__)
  if constexpr (sizeof(Real) == 4) {
    const float4 v = __ldg(reinterpret_cast<const float4*>(a) + i);
    return {v.x, v.y, v.z, v.w};
  } else {
    const double2 v = __ldg(reinterpret_cast<const double2*>(a) + 2 * std::size_t(i));
    const double2 w = __ldg(reinterpret_cast<const double2*>(a) + 2 * std::size_t(i) + 1);
    return {v.x, v.y, w.x, w.y};
  }
#else
  return a[i];
#endif
}
template <class Real>
requires std::is_floating_point_v<Real> PBF_HD Real load(const Real* a, int i) { return a[i]; }
template <class T>
PBF_HD auto load(OwnRows<T> a, int i) {
  return load(a.rows(), i);
}
template <class T>
PBF_HD auto load(GatheredRows<T> a, Neighbor j) {
  return load(a.rows(), j.row);
}

/// False for NaN and infinities, without a library call (x - x is 0 only for finite x).
template <class Real>
PBF_HD bool is_finite(Real x) {
  return x - x == Real(0);
}

}  // namespace pbf::PBF_VARIANT
