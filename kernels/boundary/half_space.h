// The density of the half space behind a plane wall, filled with fluid at rest, in closed form.
// q = distance/h from the wall.
#pragma once

#include "kernels/smoothing.h"

namespace pbf::PBF_VARIANT {

/// Density of the half space, as a fraction of rho0, and its gradient along the inward normal
/// (negative: it decreases inward), both 0 for q >= 1. A particle on or behind the wall: q = 0.
/// Real: a number, or several of them (kernels/lanes.h).
template <class Real>
struct HalfSpace {
  Real density = 0, slope = 0;
};
/// g where the condition holds, elsewhere 0.
template <class Condition, class Real>
PBF_HD HalfSpace<Real> only_where(const Condition& c, HalfSpace<Real> g) {
  return {choose(c, g.density, Real(0)), choose(c, g.slope, Real(0))};
}

/// Spiky: D = (1-q)^5 (1+2q)/2; its derivative:
/// D' = (1-q)^4 (-5(1+2q) + 2(1-q))/2 = -(3/2)(1-q)^4 (1+4q).
template <class Real>
PBF_HD HalfSpace<Real> half_space_spiky(Real q) {
  const auto near = q < Real(1);
  if (!holds_somewhere(near)) return {};
  q = max2(q, Real(0));
  Real t = Real(1) - q, t2 = t * t, t4 = t2 * t2;
  return only_where(near, HalfSpace<Real>{Real(0.5) * t4 * t * (Real(1) + q + q),
                                          Real(-1.5) * t4 * (Real(1) + Real(4) * q)});
}

/// Poly6: D = 1/2 - 315/256 (q - 4q^3/3 + 6q^5/5 - 4q^7/7 + q^9/9), D' = -315/256 (1-q^2)^4.
template <class Real>
PBF_HD HalfSpace<Real> half_space_poly6(Real q) {
  const auto near = q < Real(1);
  if (!holds_somewhere(near)) return {};
  q = max2(q, Real(0));
  Real s = q * q, u = Real(1) - s, u2 = u * u;
  Real p = Real(1) + s * (Real(-4.0 / 3.0) +
                          s * (Real(6.0 / 5.0) + s * (Real(-4.0 / 7.0) + s * Real(1.0 / 9.0))));
  Real a = Real(315.0 / 256.0);
  return only_where(near, HalfSpace<Real>{max2(Real(0.5) - a * q * p, Real(0)), -a * u2 * u2});
}

/// In two dimensions D = (1-q)^m P(q), P = 1/2 + c1 q + c2 q^2 + c3 q^3 + c4 q^4, is fitted to the
/// integral over the half plane, which has no simple form (accuracy: kernels/README.md (9)). The
/// slope is the derivative of D, (1-q)^(m-1) ((1-q) P' - m P).
template <int m, class Real>
PBF_HD HalfSpace<Real> half_plane(Real q, Real c1, Real c2, Real c3, Real c4) {
  static_assert(m == 4 || m == 5);
  const auto near = q < Real(1);
  if (!holds_somewhere(near)) return {};
  q = max2(q, Real(0));
  const Real t = Real(1) - q, t3 = t * t * t, before = m == 5 ? t3 * t : t3;
  const Real p = Real(0.5) + q * (c1 + q * (c2 + q * (c3 + q * c4)));
  const Real dp = c1 + q * (Real(2) * c2 + q * (Real(3) * c3 + q * (Real(4) * c4)));
  return only_where(near, HalfSpace<Real>{before * t * p, before * (t * dp - Real(m) * p)});
}
template <class Real>
PBF_HD HalfSpace<Real> half_plane_spiky(Real q) {
  return half_plane<5>(q, Real(0.90627), Real(-0.19345), Real(1.18431), Real(0));
}
template <class Real>
PBF_HD HalfSpace<Real> half_plane_poly6(Real q) {
  return half_plane<4>(q, Real(0.83646), Real(0.31849), Real(-0.09827), Real(-0.75489));
}

/// The half space for the kernel of the gradient, and for that of the density.
template <class Real, Smoothing S>
PBF_HD HalfSpace<Real> gradient_half_space(Real q) {
  if constexpr (dimensions_of(S) == 2) return half_plane_spiky(q);
  return half_space_spiky(q);
}
template <class Real, Smoothing S>
PBF_HD HalfSpace<Real> density_half_space(Real q) {
  if constexpr (!is_paper(S)) return gradient_half_space<Real, S>(q);
  if constexpr (dimensions_of(S) == 2) return half_plane_poly6(q);
  return half_space_poly6(q);
}

}  // namespace pbf::PBF_VARIANT
