// XSPH viscosity. Schechter & Bridson 2012, eq. 6; Macklin & Mueller 2013, eq. 17.
#pragma once

#include "kernels/pair_sum.h"
#include "kernels/pass_predict.h"

namespace pbf::inline PBF_VARIANT {

/// v_i += c sum_j m/rho_j (v_j - v_i) W_ij, with the density of the last sweep. With
/// `more_to_come` it also gives the particle its bin in the next update: that update's `predict`.
template <class Real, class Lists, Smoothing S, bool more_to_come>
struct XsphPass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>* position;  ///< w = 1/density
  const Vec4<Real>* velocity;  ///< h/s
  Vec4<Real>* velocity_out;
  int* bin;  ///< out

  using Own = MovingOwn<Real>;
  using Other = MovingOther<Real>;
  using Sum = VectorSum<Real>;
  PBF_HD Own own(int i) const { return {xyz(position[i]), xyz(velocity[i])}; }
  PBF_HD Other other(int j) const { return {load(position, j), load(velocity, j)}; }
  PBF_HD void add(Sum& s, const Own& a, const Other& b, int, int, bool on) const {
    const Real q2 = pair_q_squared(a.x - xyz(b.x), on);
    const Real shape =
        density_shape<Real, S>(q2, S == Smoothing::paper ? Real(0) : Spiky<Real>::t(root_of(q2).q));
    s.v = s.v + (shape * b.x.w) * (xyz(b.v) - a.v);
  }
  PBF_HD void finish(int i, const Own& a, const Sum& s) const {
    const Vec3<Real> v = a.v + (p.xsph * p.vol * density_norm<Real, S>()) * s.v;
    velocity_out[i] = with_w(v, Real(0));
    if constexpr (more_to_come) bin[i] = bin_of(predict(a.x, v, p).x, p);
  }
  PBF_HD void operator()(int i) const { sum_over_neighbors(*this, i); }
};

}  // namespace pbf::inline PBF_VARIANT
