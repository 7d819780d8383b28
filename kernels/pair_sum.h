// The interface of every pass that sums over neighbors. An executor may choose how threads share
// the sums (one particle each, two particles each, several lanes for one).
//
// Such a pass has
//   D                                  dimensions of the scene
//   own(i) const                       data of particle i: position, lambda, ...
//   other(j) const                     data gathered from a neighbor
//   SumOf<V> (value-initialized to 0)  and each(f): f(V&) for every member
//   add(SumOf<V>&, own, other) const   adds the term of one neighbor
//   finish(i, Own, Sum) const          writes the result
//   together(Sum) const                optional: whether finish() may be called for several
//                                      particles at once, like add()
//   stays_far, far_bound               if it moves particles: boundary/near_split.h
// V is Real for one particle and Lanes for several at once (kernels/lanes.h). Own and Sum are the
// types for one particle. A finish() for several has the same formulas with choose() for branches.
#pragma once

#include "kernels/neighbors.h"
#include "kernels/smoothing.h"

namespace pbf::PBF_VARIANT {

/// One particle on one thread: the sequential form, and the reference for the others.
template <class Pass>
PBF_HD void sum_over_neighbors(const Pass& pass, int i) {
  const typename Pass::Own own = pass.own(i);
  typename Pass::Sum sum{};
  pass.lists.for_each(i, [&](Neighbor j) { pass.add(sum, own, pass.other(j)); });
  pass.finish(i, own, sum);
}

template <class V, class F>
PBF_HD constexpr void each_component(Vec3<V>& v, F&& f) {
  f(v.x);
  f(v.y);
  f(v.z);
}
template <class V, class F>
PBF_HD constexpr void each_component(Vec2<V>& v, F&& f) {
  f(v.x);
  f(v.z);
}
template <class V, class F>
PBF_HD constexpr void each_component(V& v, F&& f) {
  f(v);
}

/// A sum of one vector.
template <class V, int dimensions>
struct VectorSum {
  Vec<V, dimensions> v;
  template <class F>
  PBF_HD constexpr void each(F&& f) {
    each_component(v, f);
  }
};

/// Data of the particle and of a neighbor in a sum over velocity differences.
template <class V, int dimensions>
struct MovingOwn {
  Vec<V, dimensions> x, v;
};
template <int dimensions, class V>
PBF_HD MovingOwn<V, dimensions> moving_own(const Vec4<V>& x, const Vec4<V>& v) {
  return {point<dimensions>(x), point<dimensions>(v)};
}
template <class V>
struct MovingOther {
  Vec4<V> x, v;  ///< x.w = 1/density
};
template <class V>
PBF_HD MovingOther<V> moving_other(const Vec4<V>& x, const Vec4<V>& v) {
  return {x, v};
}

}  // namespace pbf::PBF_VARIANT
