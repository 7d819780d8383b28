// density and lambda. Macklin & Mueller 2013, eq. 2 (density), 1 (C), 8 (gradient), 11 (lambda).
#pragma once

#include <type_traits>

#include "kernels/pair_sum.h"
#include "kernels/relative_motion.h"

namespace pbf::PBF_VARIANT {

/// Density in units of rho0 at the present positions, walls included.
template <class Real, class Lists, Smoothing S, class Boundary>
struct DensityPass {
  Params<Real> p;
  Boundary boundary;
  Lists lists;
  GatheredRows<Vec4<Real>> position;
  OwnRows<Real> density;  ///< out

  static constexpr int D = dimensions_of(S);
  using Own = Vec<Real, D>;
  template <class V>
  struct SumOf {
    V shape{};
    template <class F>
    PBF_HD constexpr void each(F&& f) {
      f(shape);
    }
  };
  using Sum = SumOf<Real>;
  template <class Index>
  PBF_HD auto own(Index i) const {
    return point<D>(load(position, i));
  }
  template <class Index>
  PBF_HD auto other(Index j) const {
    return point<D>(load(position, j));
  }
  template <class V>
  PBF_HD void add(SumOf<V>& s, const Vec<V, D>& x, const Vec<V, D>& y) const {
    const Vec<V, D> d = x - y;
    const V q2 = dot(d, d);
    s.shape += density_shape<Real, S>(q2, is_paper(S) ? V(0) : Spiky<Real>::t(root_of(q2).q));
  }
  template <class V>
  PBF_HD bool together(const SumOf<V>&) const requires(!Boundary::books) {
    return true;
  }
  template <class Index, class V>
  PBF_HD void finish(Index i, const Vec<V, D>& x, const SumOf<V>& s) const {
    // 1: the particle itself.
    set_row(density, i,
            p.vol * density_norm<Real, S>() * (Real(1) + s.shape) +
                boundary.template term<S>(in_space(x)).density);
  }
};

/// C from the density: one-sided by default (only compression is corrected). NaN stays NaN, so that
/// it is detected.
template <class V, class Real>
PBF_HD V constraint(V density, const Params<Real>& p) {
  const V c = density - Real(1);
  return p.two_sided ? c : choose(c < Real(0), V(0), c);
}

/// Divisor of lambda if the scene leaves the step length to the program: 1 + 3 C above the rest
/// density, at most 2. Jacobi iterations overshoot if there are many neighbors. The default of
/// omega depends on their number at rest (lib/program/plan.h), this divisor on the excess. Without
/// the limit of 2, or with rho^3, a pool collapsed under large steps.
template <class V, class Real>
PBF_HD V under_relaxation(V density, const Params<Real>& p) {
  if (!p.under_relax) return V(1);
  return choose(density > Real(1), min2(Real(3) * density - Real(2), V(2)), V(1));
}

/// lambda_i = -C_i / (sum_k |grad_k C_i|^2 + eps^) / under_relaxation(rho_i), in h^2. with_density:
/// the density is summed in the same loop (fused); otherwise it is read.
template <class Real, class Lists, Smoothing S, bool with_density, class Order, class Boundary>
struct LambdaPass {
  Params<Real> p;
  Boundary boundary;
  Lists lists;
  GatheredRows<Vec4<Real>> position;
  /// out: where the corrections take their directions, x* - back v (x* in first order), and
  /// w = lambda
  OwnRows<Vec4<Real>> position_out;
  OwnRows<std::conditional_t<with_density, Real, const Real>> density;  ///< out, or in
  GatheredRows<Vec4<Real>> velocity;  ///< in first order for count_unresolved() alone
  StepCounts* counts;

  static constexpr int D = dimensions_of(S);
  using Own = Vec<Real, D>;
  template <class V>
  struct SumOf {
    V shape{}, squares{};
    Vec<V, D> gradient;
    template <class F>
    PBF_HD constexpr void each(F&& f) {
      if constexpr (with_density) f(shape);
      f(squares);
      each_component(gradient, f);
    }
  };
  using Sum = SumOf<Real>;
  template <class Index>
  PBF_HD auto own(Index i) const {
    return point<D>(load(position, i));
  }
  template <class Index>
  PBF_HD auto other(Index j) const {
    return point<D>(load(position, j));
  }
  template <class V>
  PBF_HD void add(SumOf<V>& s, const Vec<V, D>& x, const Vec<V, D>& y) const {
    const Vec<V, D> d = x - y;
    add_pair(s, d, dot(d, d));
  }
  /// d: in the unit of the gradient's sum.
  template <class V>
  PBF_HD void add_pair(SumOf<V>& s, const Vec<V, D>& d, V q2) const {
    const Root<V> root = root_of(q2);
    const V t = Spiky<Real>::t(root.q), t2 = t * t;
    if constexpr (with_density) s.shape += density_shape<Real, S>(q2, t);
    s.squares += t2 * t2;
    // A coincident pair (d = 0) adds no gradient, which is the mean over all directions.
    s.gradient = s.gradient + (t2 * root.inverse) * d;
  }
  template <class V>
  PBF_HD bool together(const SumOf<V>&) const requires(!Boundary::books) {
    return true;
  }
  template <class Index, class V>
  PBF_HD void finish(Index i, const Vec<V, D>& x, const SumOf<V>& s) const {
    const BoundaryTerm<V> wall = boundary.template term<S>(in_space(x));
    V rho;
    if constexpr (with_density) {
      rho = p.vol * density_norm<Real, S>() * (Real(1) + s.shape) + wall.density;
      set_row(density, i, rho);
    } else {
      rho = row(density, i);
    }
    const Real a = p.vol * Spiky<Real, D>::gradient_norm;
    const Vec3<V> own_gradient = a * in_space(s.gradient) + wall.gradient;
    const V c = constraint(rho, p);
    V denominator = a * a * s.squares + dot(own_gradient, own_gradient) + p.cfm;
    if constexpr (Boundary::books) denominator += boundary.template ease<S>(i, in_space(x));
    // The denominator is 0 without neighbors, walls and cfm.
    const V lambda =
        choose(denominator > Real(0), -c / (under_relaxation(rho, p) * denominator), V(0));
    Vec3<V> place = in_space(x);
    // x* - dt v is where the step began, since v takes part in every displacement.
    if constexpr (Order::second) place = place - p.back * xyz(load(velocity, i));
    set_row(position_out, i, with_w(place, lambda));
    // At the end, where few registers are in use.
    for_rows_where(load(position, i).w < Real(0), i,
                   [&](int k) { count_unresolved(k, p, lists, velocity, counts); });
  }
};

}  // namespace pbf::PBF_VARIANT
