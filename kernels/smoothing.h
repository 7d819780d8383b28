// Smoothing functions in units of h (q = r/h, 0 <= q <= 1), integral 1 over the unit ball, or over
// the unit disc in two dimensions.
// Mueller, Charypar & Gross 2003, eq. 20 (Poly6) and 21 (Spiky). V: Real, or several of them
// (kernels/lanes.h).
#pragma once

#include "kernels/vec3.h"

namespace pbf::PBF_VARIANT {

/// Which pair of functions a scene uses; a template argument of the pair loops.
/// consistent: Spiky for the density and, as its derivative, for the gradient;
/// paper: Poly6 for the density, Spiky for the gradient (Macklin & Mueller 2013). Each exists in
/// three and in two dimensions.
enum class Smoothing { consistent, paper, consistent_2d, paper_2d };
constexpr bool is_paper(Smoothing s) { return s == Smoothing::paper || s == Smoothing::paper_2d; }
constexpr int dimensions_of(Smoothing s) {
  return s == Smoothing::consistent_2d || s == Smoothing::paper_2d ? 2 : 3;
}

constexpr double kPi = 3.14159265358979323846;

template <class Real, int dimensions = 3>
struct Poly6 {
  static constexpr Real norm = Real(dimensions == 2 ? 4.0 / kPi : 315.0 / (64.0 * kPi));
  /// (1 - q^2)^3, 0 beyond q = 1; times `norm` it is W.
  template <class V>
  static PBF_HD V shape(V q_squared) {
    const V t = max2(V(1) - q_squared, V(0));
    return t * t * t;
  }
};

template <class Real, int dimensions = 3>
struct Spiky {
  static constexpr Real norm = Real((dimensions == 2 ? 10.0 : 15.0) / kPi);
  static constexpr Real gradient_norm = Real((dimensions == 2 ? -30.0 : -45.0) / kPi);
  /// 1 - q, 0 beyond q = 1; W = norm t^3, dW/dq = gradient_norm t^2.
  template <class V>
  static PBF_HD V t(V q) {
    return max2(V(1) - q, V(0));
  }
  /// The same from q^2, with the same bits in every kernel: see mul_add().
  template <class V>
  static PBF_HD V t_of_square(V q_squared) {
    const auto root = root_of(q_squared);
#ifdef PBF_FAST_DEVICE
    return max2(mul_add(-q_squared, root.inverse, V(1)), V(0));
#else
    return t(root.q);
#endif
  }
};

template <class Real, Smoothing S>
PBF_HD Real density_norm() {
  return is_paper(S) ? Poly6<Real, dimensions_of(S)>::norm : Spiky<Real, dimensions_of(S)>::norm;
}

/// The shape of the density kernel, from the q^2 and t = max(1 - q, 0) of a pair loop.
template <class Real, Smoothing S, class V>
PBF_HD V density_shape(V q_squared, V t) {
  if constexpr (is_paper(S)) return Poly6<Real>::shape(q_squared);
  return t * t * t;
}

/// Squared distance (in h^2) below which two particles count as coincident: their direction is then
/// chosen, not computed. It is far above the smallest normal float.
template <class Real>
PBF_HD Real coincident_q_squared() {
  return Real(1e-24);
}

/// A unit vector for a coincident pair with ids i and j, from an integer hash; exchanging i and j
/// changes its sign. The pair separates in the same way in every run, on every backend and in any
/// order of rows. In two dimensions the vector lies in the plane.
template <class Real, int dimensions = 3>
PBF_HD Vec3<Real> separation(int i, int j) {
  unsigned a = unsigned(i < j ? i : j), b = unsigned(i < j ? j : i);
  unsigned k = a * 2654435761u ^ (b * 2246822519u + 374761393u);
  k ^= k >> 15;
  k *= 2654435761u;
  k ^= k >> 13;
  // A point of the unit sphere: z uniform, the angle by a rational parametrization, because
  // trigonometric functions differ between libraries.
  Real z = Real(k & 1023u) * Real(2.0 / 1023.0) - Real(1);
  Real u = Real((k >> 10) & 1023u) * Real(2.0 / 1023.0) - Real(1);
  Real s = square_root(max2(Real(1) - z * z, Real(0)));
  Real d = Real(1) / (Real(1) + u * u);
  Real cx = (Real(1) - u * u) * d, cy = (u + u) * d;
  if (k & (1u << 20)) cx = -cx;
  Vec3<Real> e{s * cx, s * cy, z};
  if constexpr (dimensions == 2) e = {cx, Real(0), cy};
  return i < j ? e : Real(-1) * e;
}

}  // namespace pbf::PBF_VARIANT
