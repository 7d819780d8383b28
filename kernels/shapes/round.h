// Common parts of shapes with a round side, which is at a fixed distance from a center or an axis.
#pragma once

#include "kernels/shapes/faces.h"

namespace pbf::PBF_VARIANT {

/// The part of the line a + t d within `radius` of the origin.
template <class Real>
PBF_HD LineSpan<Real> line_span_in_radius(Vec3<Real> a, Vec3<Real> d, Real radius) {
  constexpr Real ever(1e30);
  const Real dd = dot(d, d);
  if (!(dd > Real(1e-30)))
    return dot(a, a) < radius * radius ? LineSpan<Real>{-ever, ever} : LineSpan<Real>{};
  const Real middle = -dot(a, d) / dd;
  const Vec3<Real> p = a + middle * d;  // not b^2 - ac: that cancels on long paths
  const Real rest = radius * radius - dot(p, p);
  if (!(rest > Real(0))) return {};
  const Real half = square_root(rest / dd);
  return {middle - half, middle + half};
}

/// The tangent plane in direction d from a center or an axis.
template <class Real>
PBF_HD Tangent<Real> round_tangent(Vec3<Real> d, Real level) {
  const Real length = square_root(dot(d, d));
  return {length > Real(1e-15) ? (Real(1) / length) * d : Vec3<Real>{}, level};
}

/// The position of a point relative to a center or an axis, in ranges.
template <class Real>
struct RoundPlace {
  Vec3<Real> away;
  Real radius, distance, inverse;
  bool beyond;  ///< out of reach
};
template <class Real>
PBF_HD RoundPlace<Real> round_place(Vec3<Real> away, Real radius, Real inv_range) {
  const Real one(1);
  radius = radius * inv_range;
  const Vec3<Real> d = inv_range * away;
  const Real square = dot(d, d), reach = radius + one;
  if (square >= reach * reach) return {d, radius, Real(0), Real(0), true};
  const Real c = square_root(square);
  return {d, radius, c, one / max2(c, Real(1e-20)), false};
}

/// The term of a round side with `bend` along its second direction (RoundShare), between the planes
/// of `slab`; both come with their derivatives along the body's z.
template <Smoothing S, bool of_density, class Real>
PBF_HD SolidTerm<Real> round_term(const RoundPlace<Real>& p, HalfSpace<Real> bend,
                                  HalfSpace<Real> slab) {
  const RoundShare<Real> g =
      round_share<S, of_density>(p.distance - p.radius, p.radius, bend.density);
  SolidTerm<Real> w{g.share * slab.density, (g.slope * slab.density * p.inverse) * p.away};
  w.gradient.z = w.gradient.z + g.by_bend * bend.slope + g.share * slab.slope;
  return w;
}

}  // namespace pbf::PBF_VARIANT
