// All points within a radius of a segment of the body's z axis.
#pragma once

#include "kernels/shapes/round.h"

namespace pbf::PBF_VARIANT {
namespace shape {

/// A step from 0 to 1 where the tube of a capsule meets its end, over 0.44 ranges on either side;
/// C2, step(-z) = 1 - step(z). The exact step also depends on the distance; error 0.03.
template <class Real>
PBF_HD HalfSpace<Real> capsule_step(Real z) {
  constexpr Real per(1 / 0.88);
  const Real s = z * per + Real(0.5);
  if (!(s > Real(0))) return {};
  if (!(s < Real(1))) return {Real(1), Real(0)};
  const Real s2 = s * s, t = Real(1) - s;
  return {s2 * s * (Real(10) - s * (Real(15) - Real(6) * s)), Real(30) * per * s2 * (t * t)};
}

template <class Real>
struct Capsule {
  static constexpr bool convex = true;
  Real radius = 0, half = 0;  ///< half the length of the axis, without the ends
  unsigned through = 0;       ///< ends that do not exist: see Span

  template <class To>
  PBF_HD Capsule<To> scaled(double by) const {
    return {To(by * double(radius)), To(by * double(half)), through};
  }
  PBF_HD Vec3<Real> ends() const { return {Real(0), Real(0), half}; }
  PBF_HD Span<Real> span() const { return span_of(half, through, 2); }

  /// The height of the point of the axis nearest to z.
  PBF_HD Real on_axis(Real z) const {
    const Span<Real> axis = span();
    return max2(min2(z, axis.high), axis.low);
  }
  PBF_HD Vec3<Real> off_axis(Vec3<Real> p) const { return {p.x, p.y, p.z - on_axis(p.z)}; }

  template <int>
  PBF_HD Real distance(Vec3<Real> p) const {
    const Vec3<Real> d = off_axis(p);
    return square_root(dot(d, d)) - radius;
  }
  template <int D>
  PBF_HD Vec3<Real> normal(Vec3<Real> p) const {
    return tangent<D>(p).normal;
  }
  template <int>
  PBF_HD Tangent<Real> tangent(Vec3<Real> p) const {
    Tangent<Real> t = round_tangent(off_axis(p), radius);
    t.level = t.level + t.normal.z * on_axis(p.z);
    return t;
  }
  template <int D>
  PBF_HD LineSpan<Real> line_span(Vec3<Real> a, Vec3<Real> way, Tangent<Real>& entry) const {
    const LineSpan<Real> tube =
        line_span_in_radius(Vec3<Real>{a.x, a.y, Real(0)}, {way.x, way.y, Real(0)}, radius);
    if (!(tube.enter < tube.leave)) return {};
    // Beyond the ends of the axis, the surface is that of the ball at the end.
    const auto at_end = [&](Real t) {
      const Real z = a.z + t * way.z, end = on_axis(z);
      return end == z ? LineSpan<Real>{t, t}
                      : line_span_in_radius(Vec3<Real>{a.x, a.y, a.z - end}, way, radius);
    };
    const LineSpan<Real> first = at_end(tube.enter), last = at_end(tube.leave);
    if (first.enter > first.leave || last.enter > last.leave) return {};
    const LineSpan<Real> inside{first.enter, last.leave};
    entry = tangent<D>(a + inside.enter * way);
    return inside;
  }
  template <Smoothing S, bool of_density>
  PBF_HD SolidTerm<Real> share(Vec3<Real> p, Real inv_range) const {
    const RoundPlace<Real> at = round_place(off_axis(p), radius, inv_range);
    if (at.beyond) return {};
    const Span<Real> axis = span();
    const HalfSpace<Real> up = capsule_step((p.z - axis.high) * inv_range);
    const HalfSpace<Real> down = capsule_step((axis.low - p.z) * inv_range);
    return round_term<S, of_density>(at, {up.density + down.density, up.slope - down.slope},
                                     {Real(1), Real(0)});
  }
  PBF_HD Bounds<Real> bounds() const {
    return {{-radius, -radius, -half - radius}, {radius, radius, half + radius}};
  }
  PBF_HD Real reach(Vec3<Real> d) const { return (d.z < Real(0) ? -d.z : d.z) * half + radius; }
  PBF_HD Real size() const { return half + radius; }
  template <int>
  PBF_HD RoundSide<Real> round(Vec3<Real>) const {
    return {radius, -half, half};
  }
};

}  // namespace shape
}  // namespace pbf::PBF_VARIANT
