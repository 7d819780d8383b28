// The share of a unit kernel that lies in half spaces, slabs, round bodies and balls, in closed
// form. Lengths in units of the kernel's range; solids are where the signed distance q is below 0.
#pragma once

#include "kernels/boundary/half_space.h"

namespace pbf::PBF_VARIANT {

/// A half space at signed distance q, and its derivative by q. `of_density`: with the kernel of the
/// density, otherwise that of the gradient.
template <Smoothing S, bool of_density, class Real>
PBF_HD HalfSpace<Real> half_space_share(Real q) {
  const Real a = q < Real(0) ? -q : q;
  HalfSpace<Real> g;
  if constexpr (of_density)
    g = density_half_space<Real, S>(a);
  else
    g = gradient_half_space<Real, S>(a);
  if (q < Real(0)) g.density = Real(1) - g.density;
  return g;
}

/// The share between two parallel planes, at signed distances `above` (upper) and `below` (lower);
/// derivative upwards. Computed from the nearer plane, so that a small share is not a difference of
/// numbers near 1.
template <Smoothing S, bool of_density, class Real>
PBF_HD HalfSpace<Real> slab_share(Real above, Real below) {
  const bool up = above > below;
  const HalfSpace<Real> near = half_space_share<S, of_density>(up ? above : below);
  const HalfSpace<Real> far = half_space_share<S, of_density>(up ? -below : -above);
  const Real slope = near.slope - far.slope;
  return {near.density - far.density, up ? slope : -slope};
}

/// m(q), the effect of curvature: for a surface with principal curvatures k1 and k2, the share is
/// S(q) - (k1 + k2)/2 m(q) to first order, m = pi int_|q|^1 (r^2 - q^2) W r dr. In the plane
/// S(q) - k m(q), m = int_|q|^1 sqrt(r^2 - q^2) W r dr; for Spiky this contains a logarithm, and a
/// polynomial within 7e-5 of it is used (its derivative within 4e-4).
template <Smoothing S, bool of_density, class Real>
PBF_HD HalfSpace<Real> curvature_moment(Real q) {
  const Real a = q < Real(0) ? -q : q, t = Real(1) - a;
  if (!(t > Real(0))) return {};
  Real m, dm;
  if constexpr (of_density && is_paper(S)) {
    const Real w = Real(1) - a * a, w4 = w * w * w * w;
    if constexpr (dimensions_of(S) == 2) {
      const Real c = Real(64.0 / (315.0 * kPi)) * square_root(w);
      m = c * w4, dm = Real(-9) * c * a * (w * w * w);
    } else {
      m = Real(63.0 / 512.0) * w4 * w, dm = Real(-630.0 / 512.0) * a * w4;
    }
  } else if constexpr (dimensions_of(S) == 2) {
    // t^4 P(a) with P'(0) = 4 P(0), so that it is even in q like the integral.
    constexpr Real c0(0.053018), c2(0.117286), c3(-0.269259);
    const Real t3 = t * t * t, p = c0 + a * (Real(4) * c0 + a * (c2 + a * c3));
    const Real dp = Real(4) * c0 + a * (Real(2) * c2 + a * (Real(3) * c3));
    m = t3 * t * p, dm = t3 * (t * dp - Real(4) * p);
  } else {
    const Real t2 = t * t, t4 = t2 * t2;
    m = t4 * t * (Real(1.5) - t * (Real(2.25) - t * Real(6.0 / 7.0)));
    dm = -t4 * (Real(7.5) - t * (Real(13.5) - t * Real(6)));
  }
  return {m, q < Real(0) ? -dm : dm};
}

/// F(q), the first moment of the kernel over a half space at distance q >= 0: the integral of z W,
/// z the height of a place over the point. By shells, or rings in the plane, it is m(q), or 2 m(q).
template <Smoothing S, class Real>
PBF_HD Real first_moment(Real q) {
  const Real m = curvature_moment<S, true>(q).density;
  return dimensions_of(S) == 2 ? m + m : m;
}

/// The share of a round body, and its derivatives.
template <class Real>
struct RoundShare {
  Real share = 0, slope = 0;  ///< and its derivative by q
  Real by_bend = 0;           ///< its derivative by `bend`
};

/// A surface with radius R along one direction of its tangent plane; along the other, `bend` goes
/// from 0 (cylinder) to 1 (sphere). In the plane, where only the other direction exists: from 0
/// (straight) to 1 (disc). The share is S(q) - k m(q)/(R + b q). k and b make the sphere exact
/// (beyond the reach of its far side) and cylinder and disc of second order:
/// S - m/(2R) (1 - 3q/(4R)). For R >= 1/0.7; for thinner bodies an estimate, never below 0.
template <Smoothing S, bool of_density, class Real>
PBF_HD RoundShare<Real> round_share(Real q, Real radius, Real bend) {
  constexpr bool flat = dimensions_of(S) == 2;
  const Real k = flat ? bend : Real(0.5) + Real(0.5) * bend, dk = flat ? Real(1) : Real(0.5);
  const Real db = flat ? Real(0) : Real(0.25), b = Real(0.75) + db * bend;
  const HalfSpace<Real> s = half_space_share<S, of_density>(q);
  const HalfSpace<Real> m = curvature_moment<S, of_density>(q);
  const Real least = max2(Real(0.25) * radius, Real(1e-3)), r = radius + b * q;
  const bool bounded = !(r > least);  // only near the center of thin bodies
  const Real inv = Real(1) / (bounded ? least : r), f = k * m.density * inv;
  if (!(s.density > f)) return {};
  const Real by_r = bounded ? Real(0) : f * inv;
  return {s.density - f, s.slope - k * m.slope * inv + b * by_r,
          db * q * by_r - dk * m.density * inv};
}

/// A ball of radius R with its center at distance c, and its derivative by c; exact for every R. Of
/// a sphere of radius r about the point, (R - r + c)(R + r - c)/(4 r c) lies in the ball. The
/// integral over r is that of a polynomial of degree 6 (Spiky) or 9 (Poly6), exact with Gauss' rule
/// of 5 nodes. Distances are r = R + v; v and the width of the interval are divided by c before
/// anything is subtracted, so the center needs no special case.
template <Smoothing S, bool of_density, class Real>
PBF_HD HalfSpace<Real> ball_share(Real c, Real radius) {
  constexpr bool poly6 = of_density && is_paper(S);
  constexpr Real node[5] = {Real(0), Real(-0.53846931010568309104), Real(0.53846931010568309104),
                            Real(-0.90617984593866399280), Real(0.90617984593866399280)};
  constexpr Real weight[5] = {Real(0.56888888888888888889), Real(0.47862867049936646804),
                              Real(0.47862867049936646804), Real(0.23692688505618908751),
                              Real(0.23692688505618908751)};
  const Real one(1), two(2), s = c - radius, nearest = s < Real(0) ? -s : s;
  const bool within = s < Real(0);
  HalfSpace<Real> all;
  if (!(nearest < one)) return {within ? one : Real(0), Real(0)};
  if (within) {  // the ball about the point that is entirely solid
    const Real r = nearest, r2 = r * r;
    if constexpr (poly6)
      all.density = Real(315.0 / 16.0) * r * r2 *
                    (Real(1.0 / 3.0) -
                     r2 * (Real(3.0 / 5.0) - r2 * (Real(3.0 / 7.0) - r2 * Real(1.0 / 9.0))));
    else
      all.density = r * r2 * (Real(20) - r * (Real(45) - r * (Real(36) - r * Real(10))));
  }
  const bool tiny = !(c > Real(1e-20));
  const Real inv_c = tiny ? Real(0) : one / c;
  const Real width = min2(one, c + radius) - nearest;
  const Real half = tiny ? one : Real(0.5) * width * inv_c;       // of the interval, over c
  const Real start = within ? -one : one - two * radius * inv_c;  // its lower end - R, over c
  for (int i = 0; i < 5; ++i) {
    const Real u = start + half * (one + node[i]), v = c * u, r = radius + v, r2 = r * r;
    const Real t = poly6 ? one - r2 : one - r;
    const Real w = weight[i] * half * r * (t * t * t) * Real(poly6 ? 315.0 / 64.0 : 15.0);
    all.density = all.density + w * (c - v) * (two * radius + v - c);
    all.slope = all.slope - w * (c - u * (two * radius + v));
  }
  return all;
}

}  // namespace pbf::PBF_VARIANT
