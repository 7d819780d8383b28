// Hyperviscosity: a viscosity of fourth order in space (biharmonic), which damps differences
// between neighbors and leaves the flow. kernels/README.md, "Second order in time".
#pragma once

#include "kernels/dissipation.h"
#include "kernels/pair_sum.h"

namespace pbf::PBF_VARIANT {

/// (L u)_i = sum_j vol W_ij (u_j - u_i) over the rows of a vector u. The weight of a pair is the
/// same for both, so the sum of L u over all particles is 0. Eigenvalues are from -0.6 to 0.
template <class Real, class Lists, Smoothing S>
struct VectorLaplacian {
  Params<Real> p;
  Lists lists;
  GatheredRows<Vec4<Real>> position;
  GatheredRows<Vec4<Real>> vector;

  static constexpr int D = dimensions_of(S);
  using Own = MovingOwn<Real, D>;
  template <class V>
  using SumOf = VectorSum<V, D>;
  using Sum = VectorSum<Real, D>;
  template <class Index>
  PBF_HD auto own(Index i) const {
    return moving_own<D>(load(position, i), load(vector, i));
  }
  template <class Index>
  PBF_HD auto other(Index j) const {
    return moving_other(load(position, j), load(vector, j));
  }
  template <class V>
  PBF_HD void add(VectorSum<V, D>& s, const MovingOwn<V, D>& a, const MovingOther<V>& b) const {
    const Vec<V, D> d = a.x - point<D>(b.x);
    const V q2 = dot(d, d);
    const V shape = density_shape<Real, S>(q2, is_paper(S) ? V(0) : Spiky<Real>::t(root_of(q2).q));
    s.v = s.v + shape * (point<D>(b.v) - a.v);
  }
  template <class V>
  PBF_HD bool together(const VectorSum<V, D>&) const {
    return true;
  }
  template <class V>
  PBF_HD Vec3<V> laplacian(const VectorSum<V, D>& s) const {
    return (p.vol * density_norm<Real, S>()) * in_space(s.v);
  }
};

/// f L v in h/s, f_i = 1/(1 + |L v|_i^2/v0^2): larger differences belong to a splash, not to fluid
/// at rest. With a factor per particle, v L f L v is still a sum of squares, so energy only falls.
template <class Real, class Lists, Smoothing S>
struct VelocityLaplacianPass : VectorLaplacian<Real, Lists, S> {
  using Base = VectorLaplacian<Real, Lists, S>;
  OwnRows<Vec4<Real>> out;  ///< f L v
  template <class Index, class V>
  PBF_HD void finish(Index i, const MovingOwn<V, Base::D>&, const VectorSum<V, Base::D>& s) const {
    const Vec3<V> l = this->laplacian(s);
    set_row(out, i, with_w((Real(1) / (Real(1) + dot(l, l) * this->p.calm)) * l, V(0)));
  }
};

/// v -= c L (f L v).
template <class Real, class Lists, Smoothing S>
struct HyperviscosityPass : VectorLaplacian<Real, Lists, S> {
  using Base = VectorLaplacian<Real, Lists, S>;
  OwnRows<Vec4<Real>> velocity;  ///< in/out, h/s
  DissipationBook book;
  template <class Index, class V>
  PBF_HD void finish(Index i, const MovingOwn<V, Base::D>&, const VectorSum<V, Base::D>& s) const {
    const Vec3<V> v = xyz(row(velocity, i)), now = v - this->p.hyperviscosity * this->laplacian(s);
    set_row(velocity, i, with_w(now, V(0)));
    book.add(i, energy_taken(v, now));
  }
};

}  // namespace pbf::PBF_VARIANT
