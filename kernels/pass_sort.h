// Passes of a counting sort by bin, within a bin by id.
#pragma once

#include "kernels/atomics.h"
#include "kernels/cell_index.h"
#include "kernels/pass_shapes.h"

namespace pbf::PBF_VARIANT {

/// What a sort works on. Rows with bins outside `bins` leave.
struct BinSort {
  BinRange bins;
  int all;        ///< bins of the grid
  const int* id;  ///< of the rows before the sort
  int* order;     ///< memory for as many rows
  int* start;     ///< out: first row of each of `bins`; at bins.end the number of rows
};

/// Counts the rows of each bin. leave: a row with a negative id gets no bin, and bins may be
/// outside the range.
template <bool leave>
struct Arrivals {
  BinRange bins{};
  int* count = nullptr;     ///< of each bin of the grid
  int* arrival = nullptr;   ///< out: a row's number in its bin, in order of arrival
  const int* id = nullptr;  ///< null: none is negative
  /// bin: of each row, in/out.
  PBF_HD void add(int* bin, int i) const {
    if (leave && id && id[i] < 0) bin[i] = -1;
    const int b = bin[i];
    if (leave ? !bins.has(b) : b < 0) return;  // < 0: left to a pass over listed rows
    arrival[i] = take_place_of(count + b);
  }
};
/// Runs `First`, which gives a row its bin, and then counts it.
template <bool leave, class First>
struct CountPass : First {
  Arrivals<leave> arrivals;
  PBF_HD void operator()(int i) const requires ItemPass<First> {
    First::operator()(i);
    arrivals.add(First::bin, row_of(static_cast<const First&>(*this), i, 0));
  }
  template <class Own, class Sum>
  PBF_HD void finish(int i, const Own& own, const Sum& sum) const {
    First::finish(i, own, sum);
    arrivals.add(First::bin, i);
  }
  /// For a pass over listed rows.
  template <class Pass>
  PBF_HD static auto row_of(const Pass& pass, int k, int) -> decltype(pass.row(k)) {
    return pass.row(k);
  }
  template <class Pass>
  PBF_HD static int row_of(const Pass&, int i, long) {
    return i;
  }
};
/// For rows that already have their bin.
struct KnownBinPass {
  int* bin;
  PBF_HD void operator()(int) const {}
};

/// Puts the ids of the rows that stay into their bins, in order of arrival, and clears the counts
/// of these bins for the next sort: most bins hold no fluid.
struct PlacePass {
  BinRange bins;
  const int *bin, *id, *start, *arrival;
  int *slot, *count;  ///< out
  PBF_HD void operator()(int i) const {
    const int b = bin[i];
    if (!bins.has(b)) return;
    slot[start[b] + arrival[i]] = id[i];
    count[b] = 0;
  }
};
/// The place of a row among those of its bin, in the order of their ids: `slot` holds these from
/// `begin` to `end`.
PBF_HD int place_in_bin(const int* slot, int begin, int end, int id) {
  int place = begin;
  for (int m = begin; m < end; ++m) place += slot[m] < id ? 1 : 0;
  return place;
}
/// Moves the rows of a bin to the order of their ids, so that the order of rows follows from the
/// positions alone: each thread counts the smaller ids in the bin of its row.
template <bool leave, class Gather>
struct OrderPass {
  BinRange bins;
  const int *bin, *id, *start, *slot;
  Gather gather;
  PBF_HD void operator()(int i) const {
    const int b = bin[i];
    if (leave && !bins.has(b)) return;
    gather(i, place_in_bin(slot, start[b], start[b + 1], id[i]));
  }
};

}  // namespace pbf::PBF_VARIANT
