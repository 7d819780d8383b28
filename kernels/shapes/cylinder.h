// A cylinder about the body's z axis; in two dimensions it is a disc.
#pragma once

#include "kernels/shapes/round.h"

namespace pbf::PBF_VARIANT {
namespace shape {

template <class Real>
struct Cylinder {
  static constexpr bool convex = true;
  Real radius = 0, half = 0;  ///< half the length of the axis
  unsigned through = 0;       ///< ends that do not exist: see Span

  template <class To>
  PBF_HD Cylinder<To> scaled(double by) const {
    return {To(by * double(radius)), To(by * double(half)), through};
  }
  PBF_HD Vec3<Real> ends() const { return {Real(0), Real(0), half}; }
  PBF_HD Span<Real> span() const { return span_of(half, through, 2); }

  template <int D>
  PBF_HD Real distance(Vec3<Real> p) const {
    FaceDistance<Real> d;
    d.face(square_root(p.x * p.x + p.y * p.y) - radius);
    if constexpr (D == 3) d.slab(p.z, span());
    return d.value();
  }
  template <int D>
  PBF_HD Vec3<Real> normal(Vec3<Real> p) const {
    return tangent<D>(p).normal;
  }
  template <int D>
  PBF_HD Tangent<Real> tangent(Vec3<Real> p) const {
    NearestFace<Real> face;
    face.best = round_tangent(Vec3<Real>{p.x, p.y, Real(0)}, radius);
    face.depth = radius - square_root(p.x * p.x + p.y * p.y);
    if constexpr (D == 3) {
      const Real out = max2(-face.depth, Real(0)), end = beyond(p.z, span());
      if (end != Real(0))
        return tangent_towards(p, out * face.best.normal + Vec3<Real>{Real(0), Real(0), end});
      face.slab(p.z, span(), 2);
    }
    return face.best;
  }
  template <int D>
  PBF_HD LineSpan<Real> line_span(Vec3<Real> a, Vec3<Real> way, Tangent<Real>& entry) const {
    LineSpan<Real> inside =
        line_span_in_radius(Vec3<Real>{a.x, a.y, Real(0)}, {way.x, way.y, Real(0)}, radius);
    if (!(inside.enter < inside.leave)) return {};
    entry = round_tangent(
        Vec3<Real>{a.x + inside.enter * way.x, a.y + inside.enter * way.y, Real(0)}, radius);
    if constexpr (D == 3) cut_line_span(inside, entry, a.z, way.z, span(), 2);
    return inside;
  }
  template <Smoothing S, bool of_density>
  PBF_HD SolidTerm<Real> share(Vec3<Real> p, Real inv_range) const {
    const Real zero(0), one(1);
    const RoundPlace<Real> at = round_place({p.x, p.y, zero}, radius, inv_range);
    if (at.beyond) return {};
    if constexpr (dimensions_of(S) == 2) {
      return round_term<S, of_density>(at, {one, zero}, {one, zero});
    } else {
      const Span<Real> s = span();
      const Real above = (p.z - s.high) * inv_range, below = (s.low - p.z) * inv_range;
      const Real side = max2(at.distance - at.radius, zero), end = max2(max2(above, below), zero);
      if (side * side + end * end >= one) return {};
      return round_term<S, of_density>(at, {zero, zero}, slab_share<S, of_density>(above, below));
    }
  }
  PBF_HD Bounds<Real> bounds() const { return {{-radius, -radius, -half}, {radius, radius, half}}; }
  PBF_HD Real reach(Vec3<Real> d) const {
    const Real z = d.z < Real(0) ? -d.z : d.z;
    return z * half + radius * square_root(max2(Real(0), Real(1) - z * z));
  }
  PBF_HD Real size() const { return radius + half; }
  template <int D>
  PBF_HD RoundSide<Real> round(Vec3<Real> p) const {
    const Vec3<Real> n = normal<D>(p);
    if (n.z * n.z > Real(0.25)) return {};
    return {radius, Real(-kEndless), Real(kEndless)};
  }
};

}  // namespace shape
}  // namespace pbf::PBF_VARIANT
