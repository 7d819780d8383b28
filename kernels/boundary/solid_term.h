// The contribution of a solid obstacle: the share of the kernel that lies in it.
#pragma once

#include "kernels/boundary/obstacle.h"

namespace pbf::PBF_VARIANT {

/// The contribution of the obstacle at x: 0 beyond the range, 1 deep inside. inv_range: h over the
/// range of the walls. The gradient is the derivative of the share with the consistent kernels;
/// with those of the paper the share uses Poly6 and the gradient Spiky, as for walls.
template <Smoothing S, class Real>
PBF_HD_APART SolidTerm<Real> solid_term(const Solid<Real>& o, Vec3<Real> x, Real inv_range) {
  constexpr int D = dimensions_of(S);
  const Vec3<Real> p = body_point<D>(o, x);
  SolidTerm<Real> w = o.shape.with([&](const auto& s) {
    SolidTerm<Real> of_shape = share_of<S, false>(s, p, inv_range);
    if constexpr (is_paper(S)) of_shape.share = share_of<S, true>(s, p, inv_range).share;
    return of_shape;
  });
  w.gradient = inv_range * turned_back<D>(o, w.gradient);
  return w;
}

}  // namespace pbf::PBF_VARIANT
