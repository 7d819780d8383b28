// density and lambda. Macklin & Mueller 2013, eq. 2 (density), 1 (C), 8 (gradient), 11 (lambda).
#pragma once

#include "kernels/boundary.h"
#include "kernels/neighbors.h"

namespace pbf {

/// Density in units of rho0 at the present positions, walls included.
template <class Real, class Lists, Smoothing S>
struct DensityPass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>* position;
  Real* density;  ///< out

  PBF_HD void operator()(int i) const {
    const Vec3<Real> xi = xyz(position[i]);
    Real sum(1);  // the particle itself
    lists.for_each(i, [&](int j) {
      const Vec3<Real> d = xi - xyz(load(position, j));
      const Real q2 = dot(d, d);
      sum += density_shape<Real, S>(
          q2, S == Smoothing::paper ? Real(0) : Spiky<Real>::t(root_of(q2).q));
    });
    density[i] = p.vol * density_norm<Real, S>() * sum + wall_term<Real, S>(xi, p).density;
  }
};

/// C from the density: one-sided by default (only compression is corrected).
template <class Real>
PBF_HD Real constraint(Real density, const Params<Real>& p) {
  const Real c = density - Real(1);
  return p.two_sided ? c : max2(c, Real(0));
}

/// lambda_i = -C_i / (sum_k |grad_k C_i|^2 + eps^), in h^2. with_density: the density is summed in
/// the same loop (fused); otherwise it is read.
template <class Real, class Lists, Smoothing S, bool with_density>
struct LambdaPass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>* position;
  Vec4<Real>* position_out;  ///< out: the same position with w = lambda
  Real* density;             ///< out when with_density, else in

  PBF_HD void operator()(int i) const {
    const Vec3<Real> xi = xyz(position[i]);
    Real sum(1), squares(0);
    Vec3<Real> g;
    lists.for_each(i, [&](int j) {
      const Vec3<Real> d = xi - xyz(load(position, j));
      const Real q2 = dot(d, d);
      const Root<Real> root = root_of(q2);
      const Real t = Spiky<Real>::t(root.q), t2 = t * t;
      if constexpr (with_density) sum += density_shape<Real, S>(q2, t);
      squares += t2 * t2;
      // A coincident pair has no direction, d = 0: its gradients cancel in the mean over
      // directions.
      g = g + (t2 * root.inverse) * d;
    });
    const WallTerm<Real> wall = wall_term<Real, S>(xi, p);
    Real rho;
    if constexpr (with_density) {
      rho = p.vol * density_norm<Real, S>() * sum + wall.density;
      density[i] = rho;
    } else {
      rho = density[i];
    }
    const Real a = p.vol * Spiky<Real>::gradient_norm;
    const Vec3<Real> own = a * g + wall.gradient;
    const Real c = constraint(rho, p), denominator = a * a * squares + dot(own, own) + p.relaxation;
    // No neighbour, no wall and no relaxation: nothing to move along.
    const Real lambda = denominator > Real(0) ? -c / denominator : Real(0);
    position_out[i] = with_w(xi, lambda);
  }
};

}  // namespace pbf
