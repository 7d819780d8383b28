// Whether a step resolves how neighbors move past each other.
#pragma once

#include "kernels/neighbors.h"
#include "kernels/step_counts.h"

namespace pbf::PBF_VARIANT {

/// h: two balls of fluid that meet head on bounce off each other as long as they approach by no
/// more than this in a step; from half a smoothing length on they pass through each other
/// (kernels/README.md, "Fast fluid").
constexpr double kResolvedWay = 0.4;

/// Counts particle i if it moves by more than kResolvedWay relative to a neighbor in this step, and
/// records the largest such distance. In such a pair, at least one particle moves by more than half
/// of it. `predict` marks these particles, and only they are checked. velocity: as predicted, h/s.
template <class Real, class Lists>
PBF_HD_RARE void count_unresolved(int i, const Params<Real>& p, const Lists& lists,
                                  GatheredRows<Vec4<Real>> velocity, StepCounts* counts) {
  constexpr Real limit = Real(kResolvedWay * kResolvedWay);
  const Vec3<Real> way = p.dt * xyz(velocity[i]);
  Real longest(0);
  lists.for_each(i, [&](Neighbor j) {
    if (j.row >= lists.far) return;  // padding of the list
    const Vec3<Real> d = way - p.dt * xyz(velocity[j]);
    longest = max2(longest, dot(d, d));
  });
  if (!(longest > limit)) return;
  count_one(&counts->unresolved);
  raise_to(&counts->way_squared, float(longest));
}

}  // namespace pbf::PBF_VARIANT
