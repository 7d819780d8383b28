// XSPH viscosity. Schechter & Bridson 2012, eq. 6; Macklin & Mueller 2013, eq. 17.
#pragma once

#include "kernels/neighbors.h"
#include "kernels/smoothing.h"

namespace pbf {

/// v_i += c sum_j m/rho_j (v_j - v_i) W_ij, with the density of the last sweep.
template <class Real, class Lists, Smoothing S>
struct XsphPass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>* position;  ///< w = 1/density
  const Vec4<Real>* velocity;  ///< h/s
  Vec4<Real>* velocity_out;

  PBF_HD void operator()(int i) const {
    const Vec3<Real> xi = xyz(position[i]), vi = xyz(velocity[i]);
    Vec3<Real> sum;
    lists.for_each(i, [&](int j) {
      const Vec4<Real> other = load(position, j);
      const Vec3<Real> d = xi - xyz(other);
      const Real q2 = dot(d, d);
      const Real shape = density_shape<Real, S>(
          q2, S == Smoothing::paper ? Real(0) : Spiky<Real>::t(root_of(q2).q));
      sum = sum + (shape * other.w) * (xyz(load(velocity, j)) - vi);
    });
    const Real a = p.xsph * p.vol * density_norm<Real, S>();
    velocity_out[i] = with_w(vi + a * sum, Real(0));
  }
};

}  // namespace pbf
