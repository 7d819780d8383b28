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

/// Runs `First`, which gives a row its bin, and then stores the row's number in that bin in order
/// of arrival. leave: a row with a negative id gets no bin, and bins may be outside the range.
template <bool leave, class First>
struct CountPass : First {
  BinRange bins;
  int *count, *arrival;  ///< count: of each bin of the grid
  const int* id;         ///< null: none is negative
  PBF_HD void operator()(int i) const requires ItemPass<First> {
    First::operator()(i);
    arrive(row_of(static_cast<const First&>(*this), i, 0));
  }
  template <class Own, class Sum>
  PBF_HD void finish(int i, const Own& own, const Sum& sum) const {
    First::finish(i, own, sum);
    arrive(i);
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
  PBF_HD void arrive(int i) const {
    if (leave && id && id[i] < 0) First::bin[i] = -1;
    const int b = First::bin[i];
    if (leave ? !bins.has(b) : b < 0) return;  // < 0: left to a pass over listed rows
    arrival[i] = take_place_of(count + b);
  }
};
/// For rows that already have their bin.
struct KnownBinPass {
  int* bin;
  PBF_HD void operator()(int) const {}
};

/// Puts the ids of the rows that stay into their bins, in order of arrival.
struct PlacePass {
  BinRange bins;
  const int *bin, *id, *start, *arrival;
  int* slot;  ///< out
  PBF_HD void operator()(int i) const {
    if (const int b = bin[i]; bins.has(b)) slot[start[b] + arrival[i]] = id[i];
  }
};
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
    const int mine = id[i], end = start[b + 1];
    int place = start[b];
    for (int m = place; m < end; ++m) place += slot[m] < mine ? 1 : 0;
    gather(i, place);
  }
};

}  // namespace pbf::PBF_VARIANT
