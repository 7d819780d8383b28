// XSPH viscosity. Schechter & Bridson 2012, eq. 6; Macklin & Mueller 2013, eq. 17; with the same
// weight for both particles of a pair, as in Monaghan 1989.
#pragma once

#include "kernels/pair_sum.h"
#include "kernels/pass_predict.h"

namespace pbf::PBF_VARIANT {

/// Data of the particle itself; w = 1/density.
template <class V, int dimensions>
struct XsphOwn {
  Vec<V, dimensions> x, v;
  V w;
};
template <int dimensions, class V>
PBF_HD XsphOwn<V, dimensions> xsph_own(const Vec4<V>& x, const Vec4<V>& v) {
  return {point<dimensions>(x), point<dimensions>(v), x.w};
}

/// v_i += c sum_j (m/rho_i + m/rho_j)/2 (v_j - v_i) W_ij, with the density of the last iteration.
/// The weight is symmetric, so momentum is kept to rounding. If an update follows, this pass also
/// computes the particle's bin for it, in place of that update's `predict`. With the same bits in
/// every kernel, because it runs alone and in a kernel with other passes: see mul_add().
template <class Real, class Lists, Smoothing S, class Order, class Boundary>
struct XsphPass {
  Params<Real> p;
  Boundary boundary;
  Lists lists;
  GatheredRows<Vec4<Real>> position;  ///< w = 1/density
  GatheredRows<Vec4<Real>> velocity;  ///< h/s
  OwnRows<Vec4<Real>> velocity_out;
  int* bin;  ///< out; null: no update follows
  DissipationBook book;
  Order order{};  ///< for bin

  static constexpr int D = dimensions_of(S);
  static constexpr bool leaves_rows = Boundary::far_only;
  using Own = XsphOwn<Real, D>;
  template <class V>
  using SumOf = VectorSum<V, D>;
  using Sum = VectorSum<Real, D>;
  template <class Index>
  PBF_HD auto own(Index i) const {
    return xsph_own<D>(load(position, i), load(velocity, i));
  }
  template <class Index>
  PBF_HD auto other(Index j) const {
    return moving_other(load(position, j), load(velocity, j));
  }
  template <class V>
  PBF_HD void add(VectorSum<V, D>& s, const XsphOwn<V, D>& a, const MovingOther<V>& b) const {
    add_pair(s, a.x - point<D>(b.x), a.w + b.x.w, point<D>(b.v) - a.v);
  }
  /// d: the distance, weight: 1/density of both, v: the difference of their velocities.
  template <class V>
  PBF_HD void add_pair(VectorSum<V, D>& s, const Vec<V, D>& d, V weight, const Vec<V, D>& v) const {
    const V q2 = square_by_mul_add(d);
    const V shape = density_shape<Real, S>(q2, is_paper(S) ? V(0) : Spiky<Real>::t_of_square(q2));
    s.v = mul_add(shape * weight, v, s.v);
  }
  template <class V>
  PBF_HD bool together(const VectorSum<V, D>&) const requires(!Boundary::far_only) {
    return true;
  }
  template <class Index, class V>
  PBF_HD void finish(Index i, const XsphOwn<V, D>& a, const VectorSum<V, D>& s) const {
    const V factor(Real(0.5) * p.xsph * p.vol * density_norm<Real, S>());
    const Vec3<V> v = in_space(mul_add(factor, s.v, a.v));
    set_row(velocity_out, i, with_w(v, V(0)));
    book.add(i, energy_taken(in_space(a.v), v));
    if (bin) set_row(OwnRows(bin), i, predicted_bin<D>(i, in_space(a.x), v, order, p, boundary));
  }
};

}  // namespace pbf::PBF_VARIANT
