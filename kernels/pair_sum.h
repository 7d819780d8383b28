// The shape of every pass that sums over neighbours, so that an executor may choose how the sums
// are shared among threads (one particle each, two particles each, several lanes for one).
//
// Such a pass has
//   Own own(int i) const               what particle i brings: position, lambda, ...
//   Other other(int j) const           what is gathered from a neighbour
//   Sum (value-initialised to zero)    and Sum::each(f): f(scalar&) for every member
//   add(Sum&, Own, Other, i, j, on)    one neighbour's share; none when `on` is false
//   finish(i, Own, Sum) const          writes the result
#pragma once

#include "kernels/neighbors.h"
#include "kernels/smoothing.h"

namespace pbf::inline PBF_VARIANT {

/// One particle on one thread: the sequential form, and the reference for the others.
template <class Pass>
PBF_HD void sum_over_neighbors(const Pass& pass, int i) {
  const typename Pass::Own own = pass.own(i);
  typename Pass::Sum sum{};
  pass.lists.for_each(i, [&](int j) { pass.add(sum, own, pass.other(j), i, j, true); });
  pass.finish(i, own, sum);
}

/// |d|^2 in h^2, or a value beyond every kernel for a pair that is switched off: selecting here
/// costs one instruction and makes every term of the pair zero.
template <class Real>
PBF_HD Real pair_q_squared(Vec3<Real> d, bool on) {
  const Real q2 = dot(d, d);
  return on ? q2 : Real(4);
}

template <class Real, class F>
PBF_HD void each_component(Vec3<Real>& v, F&& f) {
  f(v.x);
  f(v.y);
  f(v.z);
}

/// A sum of one vector.
template <class Real>
struct VectorSum {
  Vec3<Real> v;
  template <class F>
  PBF_HD void each(F&& f) {
    each_component(v, f);
  }
};

/// What the two sides bring to a sum over velocity differences.
template <class Real>
struct MovingOwn {
  Vec3<Real> x, v;
};
template <class Real>
struct MovingOther {
  Vec4<Real> x, v;  ///< x.w = 1/density
};

}  // namespace pbf::inline PBF_VARIANT
