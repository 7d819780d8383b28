// The shapes of passes. An executor has one launch function for each (lib/solver/executor.h), so a
// backend that lacks one does not compile.
#pragma once

#include <concepts>
#include <cstdint>
#include <utility>

#include "kernels/measure.h"

namespace pbf::PBF_VARIANT {

/// p(i) for every item i.
template <class P>
concept ItemPass = requires(const P p, int i) {
  p(i);
};

/// A sum over the neighbors of every particle (kernels/pair_sum.h).
template <class P>
concept PairPass = requires(const P p, int i, const typename P::Own own, typename P::Sum sum) {
  { P::D } -> std::convertible_to<int>;
  p.lists;
  { p.own(i) } -> std::convertible_to<typename P::Own>;
  p.add(sum, own, p.other(Neighbor{i}));
  p.finish(i, own, sum);
};

/// Several threads may share an item: each computes part(item, lane, of), lane 0 .. of - 1. Parts
/// are integers or bits, whose sum does not depend on order; finish(item, sum) receives it.
template <class P, class Item = int>
concept InParts = requires(const P p, Item item, typename P::Part part) {
  { p.part(item, 0, 1) } -> std::convertible_to<typename P::Part>;
  part += part;
  p.finish(item, part);
};

/// `lanes` threads share an item on a device with many threads.
template <class P>
concept SharedPass = InParts<P> && requires {
  { P::lanes } -> std::convertible_to<int>;
};

/// groups() groups of size(group) items. lanes(group, many) threads share an item: a power of two
/// up to 32, or `many`, the most threads that can add together.
template <class P>
concept TeamPass = InParts<P> && requires(const P p) {
  { p.items() } -> std::convertible_to<int>;
  { p.groups() } -> std::convertible_to<int>;
  { p.size(0) } -> std::convertible_to<int>;
  { p.lanes(0, 1) } -> std::convertible_to<int>;
};

template <class P>
using BrickOf = decltype(std::declval<const P&>().brick(0));
template <class P>
using CellOf = decltype(std::declval<const P&>().cell(std::declval<BrickOf<P>>(), 0));
template <class P>
using ShareOf = decltype(std::declval<const P&>().share(0, 0, std::int64_t(0)));

/// Over the cells of bricks, `lanes` threads per cell: finish(cell, sum) returns a cell's value,
/// finish_corner(brick, which, sum) receives the sum for a corner (kernels/levels.h).
template <class P>
concept BrickPass = InParts<P, CellOf<P>> &&
    requires(const P p, BrickOf<P> brick, CellOf<P> cell, typename P::Part part, ShareOf<P> sum) {
  { P::lanes } -> std::convertible_to<int>;
  { P::brick_cells } -> std::convertible_to<int>;
  { P::brick_corners } -> std::convertible_to<int>;
  { p.grid.bricks() } -> std::convertible_to<int>;
  { p.grid.has(cell) } -> std::same_as<bool>;
  { p.finish(cell, part) } -> std::same_as<std::int64_t>;
  sum += sum;
  p.finish_corner(brick, 0, sum);
};

/// A measurement: maxima and counts of particle i, then its terms of the sums, in units that follow
/// from the maxima.
template <class P>
concept ReducePass = requires(const P p, int i, MeasureUnits unit) {
  { p.counts(i) } -> std::same_as<MeasureCounts>;
  { p.terms(i, unit) } -> std::same_as<MeasureTerms>;
};

}  // namespace pbf::PBF_VARIANT
