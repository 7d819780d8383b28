// A half space: the solid is where the body's z is below 0.
#pragma once

#include "kernels/shapes/shape.h"

namespace pbf::PBF_VARIANT {
namespace shape {

template <class Real>
struct Plane {
  static constexpr bool convex = true, endless = true;

  template <class To>
  PBF_HD Plane<To> scaled(double) const {
    return {};
  }
  template <int>
  PBF_HD Real distance(Vec3<Real> p) const {
    return p.z;
  }
  template <int>
  PBF_HD Vec3<Real> normal(Vec3<Real>) const {
    return {Real(0), Real(0), Real(1)};
  }
  template <int D>
  PBF_HD LineSpan<Real> line_span(Vec3<Real> a, Vec3<Real> way, Tangent<Real>& entry) const {
    entry = {normal<D>(a), Real(0)};
    if (!(way.z < Real(0))) return {};
    return {a.z / -way.z, Real(1e30)};
  }
  template <Smoothing S, bool of_density>
  PBF_HD SolidTerm<Real> share(Vec3<Real> p, Real inv_range) const {
    const HalfSpace<Real> g = half_space_share<S, of_density>(p.z * inv_range);
    return {g.density, {Real(0), Real(0), g.slope}};
  }
  PBF_HD Bounds<Real> bounds() const {
    constexpr Real far(kEndless);
    return {{-far, -far, -far}, {far, far, Real(0)}};
  }
  /// It is endless except along its normal, where it ends at its face.
  PBF_HD Real reach(Vec3<Real> d) const { return d.z == Real(1) ? Real(0) : Real(kEndless); }
};

}  // namespace shape
}  // namespace pbf::PBF_VARIANT
