// With solids, a pass over neighbors has two launches. The first, over all rows, uses plain walls
// and only stores the sums of near rows. The second finishes the near rows.
#pragma once

#include "kernels/hd.h"

namespace pbf::PBF_VARIANT {

/// How many numbers a pass sums.
template <class Sum>
constexpr int numbers_of() {
  int count = 0;
  Sum{}.each([&](auto&) { ++count; });
  return count;
}

/// Stores the sum of near row i: four numbers in NearRows::sums, a fifth in the density, which the
/// second launch overwrites.
template <class Pass>
PBF_HD void keep_sum(const Pass& pass, int i, typename Pass::Sum sum) {
  decltype(Pass::p.dt) number[5] = {};
  int k = 0;
  sum.each([&](auto& x) { number[k++] = x; });
  pass.boundary.near.sums[i] = {number[0], number[1], number[2], number[3]};
  if constexpr (numbers_of<typename Pass::Sum>() > 4) pass.density[i] = number[4];
}
template <class Pass>
PBF_HD typename Pass::Sum kept_sum(const Pass& pass, int i) {
  const auto four = pass.boundary.near.sums[i];
  decltype(Pass::p.dt) number[5] = {four.x, four.y, four.z, four.w};
  if constexpr (numbers_of<typename Pass::Sum>() > 4) number[4] = pass.density[i];
  typename Pass::Sum sum{};
  int k = 0;
  sum.each([&](auto& x) { x = number[k++]; });
  return sum;
}

/// The first launch; Pass has the boundary FarBoundary. A pass that moves rows has
///   stays_far(i, own, sum)  whether row i, which was far, is still far afterwards
///   far_bound(own, sum)     upper bound of the square of its move, h^2; optional, for lanes
template <class Pass>
struct FarHalf : Pass {
  using typename Pass::Own;
  using typename Pass::Sum;

  PBF_HD void finish(int i, const Own& own, const Sum& sum) const {
    if (!is_far(i, own, sum)) return leave(i, sum);
    Pass::finish(i, own, sum);
  }
  /// Whether all rows of a group certainly stay far; plain() then finishes them.
  template <class Rows, class OwnRows, class SumRows>
  PBF_HD bool all_far(Rows rows, const OwnRows& own, const SumRows& sum) const {
    auto left = adjacent(this->boundary.near.way_left_squared, rows);
    if constexpr (requires { this->far_bound(own, sum); })
      return holds_everywhere(this->far_bound(own, sum) <= left);
    else
      return !moves && holds_everywhere(decltype(left)(0) <= left);
  }
  PBF_HD const Pass& plain() const { return *this; }

 private:
  static constexpr bool moves = requires(const Pass pass, const Own own, const Sum sum) {
    pass.stays_far(0, own, sum);
  };

  PBF_HD bool is_far(int i, const Own& own, const Sum& sum) const {
    if (this->boundary.near.near(i)) return false;
    if constexpr (moves) return this->stays_far(i, own, sum);
    return true;
  }
  PBF_HD_RARE void leave(int i, const Sum& sum) const {
    if (!this->boundary.near.near(i)) this->boundary.near.mark_near(i);
    keep_sum(plain(), i, sum);
  }
};

/// The second launch, over the near rows; Pass has the boundary SolidBoundary.
template <class Pass>
struct NearHalf {
  Pass pass;
  PBF_HD int row(int k) const { return pass.boundary.near.row[k]; }
  PBF_HD void operator()(int k) const {
    const int i = row(k);
    pass.finish(i, pass.own(i), kept_sum(pass, i));
  }
};

}  // namespace pbf::PBF_VARIANT
