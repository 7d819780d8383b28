// Whether a step resolves how neighbours move past each other.
#pragma once

#include "kernels/neighbors.h"
#include "kernels/step_counts.h"

namespace pbf::inline PBF_VARIANT {

/// h: two balls of fluid that meet head on bounce off each other as long as they approach by no
/// more than this in a step; from half a smoothing length on they pass through each other
/// (kernels/README.md, "Fast fluid").
constexpr double kResolvedWay = 0.4;

/// Counts particle i if it moves by more than kResolvedWay relative to a neighbour in this step,
/// and keeps the largest such way. Of two that part so fast one moves by more than half of it: such
/// particles are marked when they are predicted, and no other needs to look. velocity: as
/// predicted, h/s.
template <class Real, class Lists>
PBF_HD void count_unresolved(int i, const Params<Real>& p, const Lists& lists,
                             GatheredRows<Vec4<Real>> velocity, StepCounts* counts) {
  constexpr Real limit = Real(kResolvedWay * kResolvedWay);
  const Vec3<Real> way = p.dt * xyz(velocity[i]);
  Real longest(0);
  lists.for_each(i, [&](Neighbor j) {
    if (j.row >= lists.far) return;  // what fills up a list
    const Vec3<Real> d = way - p.dt * xyz(velocity[j]);
    longest = max2(longest, dot(d, d));
  });
  if (!(longest > limit)) return;
  count_one(&counts->unresolved);
  raise_to(&counts->way_squared, float(longest));
}

}  // namespace pbf::inline PBF_VARIANT
