// Small vectors. Only + - * / and sqrt: each is rounded the same way on every backend.
#pragma once

#include <math.h>

#include "kernels/hd.h"

namespace pbf {

template <class Real>
struct Vec3 {
  Real x = 0, y = 0, z = 0;
};

/// Four scalars moved by one 16- or 32-byte access; what w holds is said where it is used.
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
template <class R> PBF_HD Vec3<R> xyz(const Vec4<R>& a) { return {a.x, a.y, a.z}; }
template <class R> PBF_HD Vec4<R> with_w(Vec3<R> a, R w) { return {a.x, a.y, a.z, w}; }
template <class R> PBF_HD R max2(R a, R b) { return a > b ? a : b; }
template <class R> PBF_HD R min2(R a, R b) { return a < b ? a : b; }
// clang-format on

PBF_HD float square_root(float x) { return sqrtf(x); }
PBF_HD double square_root(double x) { return sqrt(x); }

/// False for NaN and infinities, without a library call (x - x is 0 only for finite x).
template <class Real>
PBF_HD bool is_finite(Real x) {
  return x - x == Real(0);
}

}  // namespace pbf
