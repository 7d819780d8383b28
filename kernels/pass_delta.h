// delta and move: the position correction of one Jacobi iteration. Macklin & Mueller 2013, eq. 12,
// 14; artificial pressure eq. 13.
#pragma once

#include <type_traits>

#include "kernels/packed_motion.h"
#include "kernels/pair_sum.h"
#include "kernels/pass_levels.h"
#include "kernels/pass_predict.h"
#include "kernels/row_state.h"

namespace pbf::PBF_VARIANT {

/// The exponent n of the artificial pressure. `fourth`: that of the paper, known when the pair loop
/// is compiled. A branch for each pair would make a GPU load neighbors one after the other.
enum class TensilePower { none, fourth, any };

/// x^n for a small positive integer n, by squaring: the same operations on every backend.
template <TensilePower tensile, class Real>
PBF_HD Real power(Real x, int n) {
  if (tensile == TensilePower::fourth || n == 4) {  // the bits of the loop
    x = x * x;
    return x * x;
  }
  Real r(1);
  for (; n > 0; n >>= 1) {
    if (n & 1) r = r * x;
    x = x * x;
  }
  return r;
}

/// dx_i = omega [ sum_j (lambda_i + lambda_j + s_corr) grad W_ij vol + lambda_i grad wall ].
/// dx/dt is added to the velocity at once. After the last iteration the velocity equals
/// (x* - x)/dt, without the cancellation of that difference.
template <class Real, class Lists, Smoothing S, TensilePower tensile, class Coarse, class Order,
          class Boundary>
struct DeltaPass {
  Params<Real> p;
  Boundary boundary;
  Lists lists;
  GatheredRows<Vec4<Real>> position;  ///< of LambdaPass, where directions are taken; w = lambda
  OwnRows<const Real> density;
  GatheredRows<int> id;                   ///< of each row
  MovedRows<Real> position_out;           ///< out: x*; w: 1/density
  OwnRows<Vec4<Real>> velocity;           ///< in/out, h/s
  StepCounts* moves_on;                   ///< not null: this pass also predicts the next substep
  [[no_unique_address]] Coarse coarse{};  ///< LevelMove or NoLevelMove
  Order order{};                          ///< with moves_on: in/out
  Vec4<Real>* motion = nullptr;           ///< out, unless null: packed_motion(), in float

  static constexpr int D = dimensions_of(S);
  static constexpr bool finish_waits = Coarse::on;  ///< for what the levels write
  template <class V>
  static constexpr bool is_one = std::is_same_v<V, Real>;  ///< particle, not several
  using Own = Vec4<Real>;
  template <class V>
  struct SumOf {
    Vec<V, D> move;
    V closeness{};  ///< sum of 1/q; above coincident() only with a coincident neighbor
    template <class F>
    PBF_HD constexpr void each(F&& f) {
      each_component(move, f);
      f(closeness);
    }
  };
  using Sum = SumOf<Real>;
  template <class Index>
  PBF_HD auto own(Index i) const {
    return load(position, i);
  }
  template <class Index>
  PBF_HD auto other(Index j) const {
    return load(position, j);
  }
  template <class V>
  PBF_HD V weight(const Vec4<V>& x, const Vec4<V>& y, V q2, V t) const {
    V w = x.w + y.w;
    if constexpr (tensile != TensilePower::none) {
      V close = density_shape<Real, S>(q2, t) * p.tensile_scale;
#ifndef PBF_FAST_DEVICE  // which handles subnormal numbers at no cost
      close = choose(close < p.tensile_from, V(0), close);
#endif
      w -= p.tensile_k * power<tensile>(close, p.tensile_n);
    }
    return w;
  }
  template <class V>
  PBF_HD void add(SumOf<V>& s, const Vec4<V>& x, const Vec4<V>& y) const {
    if constexpr (tensile == TensilePower::none && Lists::cheap_branches &&
                  sizeof(V) == sizeof(Real)) {
      if (x.w + y.w == V(0)) return;  // neither is compressed
    }
    const Vec<V, D> d = point<D>(x) - point<D>(y);
    const V q2 = dot(d, d);
    const Root<V> root = root_of(q2);
    const V t = Spiky<Real>::t(root.q);
    s.move = s.move + (weight(x, y, q2, t) * t * t * root.inverse) * d;
    s.closeness += root.inverse;
  }
  /// For the first launch (boundary/near_split.h).
  PBF_HD bool stays_far(int i, const Own& own, const Sum& s) const {
    const Vec3<Real> x = place(i, own), move = free_move(i, x, own, s);
    if (boundary.leaves(i, x, move)) return false;
    if (!moves_on) return true;
    const Vec3<Real> target = x + move, inside = boundary.path_end(x, target);
    const Vec3<Real> v = new_velocity(i, move, target, inside);
    const Vec3<Real> next = predict(inside, v, carried_push(order, i, v, p), p, boundary).x;
    return !boundary.comes_near(inside, next);
  }
  /// Larger than any allowed move if no bound is known. There is no bound with levels.
  template <class V>
  PBF_HD V far_bound(const Vec4<V>& own, const SumOf<V>& s) const requires(!Coarse::on) {
    if (moves_on) return V(coincident());
    const V twice(2), pairs(p.sor * pair_factor()), wall(p.sor * boundary.steepest());
    const V w = wall * own.w, bound = twice * (pairs * pairs * dot(s.move, s.move) + w * w);
    return max2(s.closeness - V(coincident()), bound);
  }
  template <class Index, class V>
  PBF_HD Vec3<V> new_velocity(Index i, Vec3<V> move, Vec3<V> target, Vec3<V> inside) const {
    return xyz(row(velocity, i)) + p.inv_dt * (move + (inside - target));
  }
  /// x*
  template <class Index, class V>
  PBF_HD Vec3<V> place(Index i, const Vec4<V>& own) const {
    if constexpr (Order::second)
      return xyz(own) + p.back * xyz(row(velocity, i));
    else
      return xyz(own);
  }
  template <class V, class Index>
  PBF_HD auto step(Index i) const {
    if constexpr (Order::second)
      return StepWay<V>{p.dt * xyz(row(velocity, i)), p.back * p.inv_dt};
    else
      return AnyWay{};
  }
  /// dx_i before walls and solids limit it.
  template <class Index, class V>
  PBF_HD Vec3<V> free_move(Index i, Vec3<V> x, const Vec4<V>& own, const SumOf<V>& s) const {
    Vec3<V> move = in_space(s.move);
    if constexpr (is_one<V>)
      if (s.closeness > coincident()) move = move + separate(i, own);
    const Vec3<V> wall = own.w * boundary.template push_gradient<S>(x, step<V>(i));
    const Vec3<V> all = p.sor * (pair_factor() * move + wall);
    if constexpr (Coarse::on) return all + coarse(i);
    return all;
  }
  /// Coincident neighbors are computed one by one, and so is a move into the next substep, for
  /// which the index is an int.
  template <class V>
  PBF_HD bool together(const SumOf<V>& s) const requires(!Coarse::on && !Boundary::books) {
    return !moves_on && holds_everywhere(s.closeness <= coincident());
  }
  template <class Index, class V>
  PBF_HD void finish(Index i, const Vec4<V>& own, const SumOf<V>& s) const {
    const Vec3<V> x = place(i, own), move = free_move(i, x, own, s);
    const Vec3<V> target = x + move;
    Stop<V> end;
    if constexpr (Boundary::books) {
      boundary.template book_push<S>(i, x, step<V>(i), p.sor * own.w);
      end = boundary.path_end_booked(i, x, target);
    } else {
      end.x = boundary.path_end(x, target);
    }
    const Vec3<V> inside = end.x, v = new_velocity(i, move, target, inside - end.still);
    if constexpr (std::is_same_v<Index, int>) {
      if (moves_on) {
        move_on(i, inside, v, p, boundary, position_out, velocity, order, moves_on);
        return;
      }
    }
    const V inverse_density = Real(1) / row(density, i);
    set_row(position_out, i, with_w(inside, inverse_density));
    set_row(velocity, i, with_w(v, V(0)));
    if constexpr (std::is_same_v<V, float>)
      if (motion) motion[i] = packed_motion(inside, p.dt * v, inverse_density);
  }
  PBF_HD Real pair_factor() const { return p.vol * Spiky<Real, D>::gradient_norm; }
  /// More than any sum of 1/q without coincident neighbors.
  static PBF_HD Real coincident() { return Real(0.5e12); }

  /// The displacement by coincident neighbors, whose zero distance vectors have no direction. A
  /// separate loop, so that the pair loop needs no branch.
  PBF_HD Vec3<Real> separate(int i, const Own& own) const {
    Vec3<Real> sum;
    lists.for_each(i, [&](auto j) {
      const Vec4<Real> y = load(position, j);
      const Vec3<Real> d = xyz(own) - xyz(y);
      const Real q2 = dot(d, d);
      if (q2 <= coincident_q_squared<Real>())
        sum = sum + weight(own, y, Real(0), Real(1)) *
                        separation<Real, D>(particle_of(id[i]), particle_of(id[j]));
    });
    return sum;
  }
};

}  // namespace pbf::PBF_VARIANT
