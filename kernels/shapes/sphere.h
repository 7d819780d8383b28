// A ball; in two dimensions a disc.
#pragma once

#include "kernels/shapes/round.h"

namespace pbf::PBF_VARIANT {
namespace shape {

template <class Real>
struct Sphere {
  static constexpr bool convex = true;
  Real radius = 0;

  template <class To>
  PBF_HD Sphere<To> scaled(double by) const {
    return {To(by * double(radius))};
  }
  template <int>
  PBF_HD Real distance(Vec3<Real> p) const {
    return square_root(dot(p, p)) - radius;
  }
  template <int D>
  PBF_HD Vec3<Real> normal(Vec3<Real> p) const {
    return tangent<D>(p).normal;
  }
  template <int>
  PBF_HD Tangent<Real> tangent(Vec3<Real> p) const {
    return round_tangent(p, radius);
  }
  template <int D>
  PBF_HD LineSpan<Real> line_span(Vec3<Real> a, Vec3<Real> way, Tangent<Real>& entry) const {
    const LineSpan<Real> inside = line_span_in_radius(a, way, radius);
    entry = tangent<D>(a + inside.enter * way);
    return inside;
  }
  template <Smoothing S, bool of_density>
  PBF_HD SolidTerm<Real> share(Vec3<Real> p, Real inv_range) const {
    const RoundPlace<Real> at = round_place(p, radius, inv_range);
    if (at.beyond) return {};
    if constexpr (dimensions_of(S) == 2) {
      return round_term<S, of_density>(at, {Real(1), Real(0)}, {Real(1), Real(0)});
    } else {
      const HalfSpace<Real> g = ball_share<S, of_density>(at.distance, at.radius);
      return {g.density, (g.slope * at.inverse) * at.away};
    }
  }
  PBF_HD Bounds<Real> bounds() const {
    return {{-radius, -radius, -radius}, {radius, radius, radius}};
  }
  PBF_HD Real reach(Vec3<Real>) const { return radius; }
  PBF_HD Real size() const { return radius; }
  template <int>
  PBF_HD RoundSide<Real> round(Vec3<Real>) const {
    return {radius};
  }
};

}  // namespace shape
}  // namespace pbf::PBF_VARIANT
