// Vorticity confinement, bounded by the energy loss of the flow around a particle.
// Macklin & Mueller 2013, eq. 15 and 16, in the form of kernels/README.md (13).
#pragma once

#include "kernels/dissipation.h"
#include "kernels/pair_sum.h"

namespace pbf::PBF_VARIANT {

/// grad W_ij vol/rho_j, in 1/h; zero for a coincident pair.
template <int D, class Real, class V>
PBF_HD Vec<V, D> weighted_gradient(Vec<V, D> d, V inv_rho_j, const Params<Real>& p) {
  const V q2 = dot(d, d);
  const Root<V> root = root_of(q2);
  const V t = Spiky<Real>::t(root.q);
  return (p.vol * Spiky<Real, D>::gradient_norm * t * t * root.inverse * inv_rho_j) * d;
}

/// omega_i = sum_j m/rho_j grad W_ij x (v_j - v_i), 1/s, times the gain of confinement. The gain is
/// limited by the rate at which neighbors approach: the iterations take energy only from approach,
/// and in a rigid motion there is none. In two dimensions only y is summed.
template <class Real, class Lists, int dimensions>
struct CurlPass {
  Params<Real> p;
  Lists lists;
  GatheredRows<Vec4<Real>> position;  ///< w = 1/density
  GatheredRows<Vec4<Real>> velocity;
  OwnRows<Vec4<Real>> curl;  ///< out: min(dt eps, 2 dt approach, 0.05) omega; w = |omega|

  static constexpr int D = dimensions;
  using Own = MovingOwn<Real, D>;
  template <class V>
  struct SumOf {
    decltype(cross(Vec<V, D>{}, Vec<V, D>{})) v{};
    V approach{};  ///< 1/s^2, sum_j m/rho_j W_ij (rate of approach/r)^2 over approaching neighbors
    template <class F>
    PBF_HD void each(F&& f) {
      each_component(v, f);
      f(approach);
    }
  };
  using Sum = SumOf<Real>;
  template <class Index>
  PBF_HD auto own(Index i) const {
    return moving_own<D>(load(position, i), load(velocity, i));
  }
  template <class Index>
  PBF_HD auto other(Index j) const {
    return moving_other(load(position, j), load(velocity, j));
  }
  template <class V>
  PBF_HD void add(SumOf<V>& s, const MovingOwn<V, D>& a, const MovingOther<V>& b) const {
    const Vec<V, D> d = a.x - point<D>(b.x), v = point<D>(b.v) - a.v;
    const Root<V> root = root_of(dot(d, d));
    const V t = Spiky<Real>::t(root.q), weight = p.vol * t * t * b.x.w;
    s.v = s.v + cross((Spiky<Real, D>::gradient_norm * weight * root.inverse) * d, v);
    const V rate = max2(dot(v, d) * root.inverse * root.inverse, V(0));
    s.approach += Spiky<Real, D>::norm * weight * t * rate * rate;
  }
  PBF_HD void finish(int i, const Own&, const Sum& s) const {
    const Vec3<Real> omega = in_space(s.v);
    const Real limit = min2(p.vorticity, Real(2) * square_root(s.approach));
    const Real gain = min2(p.update_dt * limit, Real(0.05));
    curl[i] = with_w(gain * omega, square_root(dot(omega, omega)));
  }
};

/// Data of the particle and of a neighbor for the gradient of |omega|; x.w = 1/density.
template <class V>
struct CurlOwn {
  Vec4<V> x, curl;
};
template <class V>
PBF_HD CurlOwn<V> curl_own(const Vec4<V>& x, const Vec4<V>& curl) {
  return {x, curl};
}
template <class V>
struct CurlOther {
  Vec4<V> x;
  V magnitude;
};
template <class V>
PBF_HD CurlOther<V> curl_other(const Vec4<V>& x, V magnitude) {
  return {x, magnitude};
}

/// v += h N x (gain omega), N = eta/(|eta| + 0.1 |omega|/h + tiny), eta = grad |omega|; gain:
/// CurlPass. Only where the density of the last iteration is at least rho0: elsewhere the
/// iterations lose no energy, and at the surface eta shows missing neighbors. N is shorter than 1
/// where |omega| is nearly constant, so it is defined for eta = 0.
template <class Real, class Lists, int dimensions>
struct VorticityPass {
  Params<Real> p;
  Lists lists;
  GatheredRows<Vec4<Real>> position;  ///< w = 1/density
  GatheredRows<Vec4<Real>> curl;      ///< times its gain; w = |omega|
  OwnRows<Vec4<Real>> velocity;       ///< in/out
  DissipationBook book;

  static constexpr int D = dimensions;
  using Own = CurlOwn<Real>;
  template <class V>
  using SumOf = VectorSum<V, D>;  ///< eta
  using Sum = VectorSum<Real, D>;
  template <class Index>
  PBF_HD auto own(Index i) const {
    return curl_own(load(position, i), load(curl, i));
  }
  template <class Index>
  PBF_HD auto other(Index j) const {
    return curl_other(load(position, j), load(curl, j).w);
  }
  template <class V>
  PBF_HD void add(VectorSum<V, D>& s, const CurlOwn<V>& a, const CurlOther<V>& b) const {
    s.v = s.v +
          (b.magnitude - a.curl.w) * weighted_gradient<D>(point<D>(a.x) - point<D>(b.x), b.x.w, p);
  }
  PBF_HD void finish(int i, const Own& a, const Sum& s) const {
    if (a.x.w > Real(1)) return;
    const Real size = square_root(dot(s.v, s.v)) + Real(0.1) * a.curl.w + Real(1e-20);
    const Vec3<Real> push = cross(in_space(s.v), xyz(a.curl));
    const Vec3<Real> v = xyz(velocity[i]), now = v + (Real(1) - p.carry) / size * push;
    velocity[i] = with_w(now, Real(0));
    book.add(i, energy_taken(v, now));
  }
};

}  // namespace pbf::PBF_VARIANT
