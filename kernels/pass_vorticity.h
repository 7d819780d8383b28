// Vorticity confinement in a form that cannot feed energy into the free surface.
// Macklin & Mueller 2013, eq. 15 and 16, stabilised as kernels/README.md (13) says.
#pragma once

#include "kernels/pair_sum.h"

namespace pbf::inline PBF_VARIANT {

/// grad W_ij vol/rho_j, in 1/h; zero for a coincident pair, and when not `on`.
template <class Real>
PBF_HD Vec3<Real> weighted_gradient(Vec3<Real> d, Real inv_rho_j, const Params<Real>& p, bool on) {
  const Real q2 = pair_q_squared(d, on);
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

  using Own = MovingOwn<Real>;
  using Other = MovingOther<Real>;
  using Sum = VectorSum<Real>;
  PBF_HD Own own(int i) const { return {xyz(position[i]), xyz(velocity[i])}; }
  PBF_HD Other other(int j) const { return {load(position, j), load(velocity, j)}; }
  PBF_HD void add(Sum& s, const Own& a, const Other& b, int, int, bool on) const {
    s.v = s.v + cross(weighted_gradient(a.x - xyz(b.x), b.x.w, p, on), xyz(b.v) - a.v);
  }
  PBF_HD void finish(int i, const Own&, const Sum& s) const {
    curl[i] = with_w(s.v, square_root(dot(s.v, s.v)));
  }
  PBF_HD void operator()(int i) const { sum_over_neighbors(*this, i); }
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

  struct Own {
    Vec4<Real> x, curl;
  };
  struct Other {
    Vec4<Real> x;
    Real magnitude;
  };
  using Sum = VectorSum<Real>;  ///< eta
  PBF_HD Own own(int i) const { return {position[i], curl[i]}; }
  PBF_HD Other other(int j) const { return {load(position, j), load(curl, j).w}; }
  PBF_HD void add(Sum& s, const Own& a, const Other& b, int, int, bool on) const {
    s.v = s.v + (b.magnitude - a.curl.w) * weighted_gradient(xyz(a.x) - xyz(b.x), b.x.w, p, on);
  }
  PBF_HD void finish(int i, const Own& a, const Sum& s) const {
    if (a.x.w * Real(0.75) > Real(1)) return;
    const Real size = square_root(dot(s.v, s.v)) + Real(0.1) * a.curl.w + Real(1e-20);
    const Real gain = min2(p.dt * p.vorticity, Real(0.05)) / size;
    velocity[i] = with_w(xyz(velocity[i]) + gain * cross(s.v, xyz(a.curl)), Real(0));
  }
  PBF_HD void operator()(int i) const { sum_over_neighbors(*this, i); }
};

}  // namespace pbf::inline PBF_VARIANT
