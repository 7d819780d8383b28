// Vorticity confinement in a form that cannot feed energy into the free surface.
// Macklin & Mueller 2013, eq. 15 and 16, stabilised as kernels/README.md (13) says.
#pragma once

#include "kernels/neighbors.h"
#include "kernels/smoothing.h"

namespace pbf {

/// grad W_ij vol/rho_j, in 1/h; zero for a coincident pair.
template <class Real>
PBF_HD Vec3<Real> weighted_gradient(Vec3<Real> d, Real inv_rho_j, const Params<Real>& p) {
  const Real q2 = dot(d, d);
  const Root<Real> root = root_of(q2);
  const Real t = Spiky<Real>::t(root.q);
  return (p.vol * Spiky<Real>::gradient_norm * t * t * root.inverse * inv_rho_j) * d;
}

/// omega_i = sum_j m/rho_j grad W_ij x (v_j - v_i), 1/s; w = |omega_i|.
template <class Real, class Lists>
struct CurlPass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>* position;  ///< w = 1/density
  const Vec4<Real>* velocity;
  Vec4<Real>* curl;  ///< out

  PBF_HD void operator()(int i) const {
    const Vec3<Real> xi = xyz(position[i]), vi = xyz(velocity[i]);
    Vec3<Real> sum;
    lists.for_each(i, [&](int j) {
      const Vec4<Real> other = load(position, j);
      sum =
          sum + cross(weighted_gradient(xi - xyz(other), other.w, p), xyz(load(velocity, j)) - vi);
    });
    curl[i] = with_w(sum, square_root(dot(sum, sum)));
  }
};

/// v += min(dt eps, 0.05) h (N x omega), N = eta/(|eta| + 0.1 |omega|/h + tiny), eta = grad
/// |omega|. Left out at the surface (density below 0.75 rho0), where the gradient is that of the
/// missing neighbours. N is no longer a unit vector where |omega| is flat, so it is defined at eta
/// = 0.
template <class Real, class Lists>
struct VorticityPass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>* position;  ///< w = 1/density
  const Vec4<Real>* curl;
  Vec4<Real>* velocity;  ///< in/out

  PBF_HD void operator()(int i) const {
    const Vec4<Real> own = position[i];
    if (own.w * Real(0.75) > Real(1)) return;
    const Vec3<Real> xi = xyz(own), omega = xyz(curl[i]);
    const Real magnitude = curl[i].w;
    Vec3<Real> eta;
    lists.for_each(i, [&](int j) {
      const Vec4<Real> other = load(position, j);
      eta = eta + (load(curl, j).w - magnitude) * weighted_gradient(xi - xyz(other), other.w, p);
    });
    const Real size = square_root(dot(eta, eta)) + Real(0.1) * magnitude + Real(1e-20);
    const Real gain = min2(p.dt * p.vorticity, Real(0.05)) / size;
    velocity[i] = with_w(xyz(velocity[i]) + gain * cross(eta, omega), Real(0));
  }
};

}  // namespace pbf
