// Rows that change ranks, and copies of rows for adjacent ranks (lib/exec/ranks/rank_rows.h).
#pragma once

#include <cstdint>

#include "kernels/atomics.h"
#include "kernels/cell_index.h"
#include "kernels/params.h"
#include "kernels/pass_shapes.h"
#include "kernels/row_state.h"
#include "kernels/step_counts.h"

namespace pbf::PBF_VARIANT {

/// A pass over the rows from `first` on, as items 0, 1, ...
template <class Pass>
struct From {
  Pass pass;
  int first;
  PBF_HD auto operator()(int i) const { return pass(first + i); }
  PBF_HD auto counts(int i) const { return pass.counts(first + i); }
  PBF_HD auto terms(int i, const MeasureUnits& unit) const { return pass.terms(first + i, unit); }
};
/// A pass over listed rows, without those that are not own rows.
template <class Pass>
struct OwnOf {
  Pass pass;
  RowRange own;
  PBF_HD void operator()(int k) const {
    if (const int i = pass.row(k); i >= own.first && i < own.last) pass(k);
  }
};

/// The ranks that need a row: that of its layer of cells, and those of the adjacent layers.
struct LayerRanks {
  const int* owner;  ///< rank of each layer
  int layers, bins;  ///< bins of a layer
  int me;            ///< this rank

  struct Span {
    int low, high;
    PBF_HD bool has(int rank) const { return low <= rank && rank <= high; }
  };
  PBF_HD Span operator()(int bin) const {
    const int layer = bin / bins;
    return {owner[layer > 0 ? layer - 1 : 0], owner[layer + 1 < layers ? layer + 1 : layers - 1]};
  }
};

/// Lists of own rows for each other rank; beyond `room` rows are only counted.
struct RowLists {
  LayerRanks ranks;
  int* list;         ///< of each rank: `room` rows
  int* count;        ///< of each rank, and then of all rows that go beyond the adjacent ones
  int room, number;  ///< number of ranks

  PBF_HD void add(int i, int bin) const {
    const auto to = ranks(bin);
    const int me = ranks.me;
    if (to.has(me - 1)) put(i, me - 1, take_place(count + me - 1));
    if (to.has(me + 1)) put(i, me + 1, take_place(count + me + 1));
    for (int r = to.low; r <= to.high; ++r)
      if (r < me - 1 || r > me + 1) {
        put(i, r, take_place_of(count + r));
        take_place_of(count + number);
      }
  }
  PBF_HD void put(int i, int rank, int place) const {
    if (place < room) list[std::int64_t(rank) * room + place] = i;
  }
};
/// Runs `First`, which gives a row its bin, and lists the row.
template <class First>
struct SelectRowsPass : First {
  RowLists to;
  PBF_HD void operator()(int i) const requires ItemPass<First> {
    First::operator()(i);
    to.add(i, First::bin[i]);
  }
  template <class Own, class Sum>
  PBF_HD void finish(int i, const Own& own, const Sum& sum) const {
    First::finish(i, own, sum);
    to.add(i, First::bin[i]);
  }
};
/// Lists rows that have their bin.
struct ListRowsPass {
  const int* bin;
  RowLists to;
  PBF_HD void operator()(int i) const { to.add(i, bin[i]); }
};

/// The fields of rows in a message: all of a row, then those of the next.
struct RowFields {
  static constexpr int most = 16;
  std::uint32_t* rows[most] = {};
  int begin[most + 1] = {};  ///< words of 4 bytes, of a row
  int fields = 0;

  PBF_HD int words() const { return begin[fields]; }
  /// A word of row i. word: of all fields.
  PBF_HD std::uint32_t& at(std::int64_t i, int word) const {
    int f = 0;
    while (word >= begin[f + 1]) ++f;
    return rows[f][i * (begin[f + 1] - begin[f]) + word - begin[f]];
  }
};
/// Copies listed rows to a message; for each of its words.
struct PackRowsPass {
  RowFields fields;
  const int* list;
  std::uint32_t* to;
  PBF_HD void operator()(int k) const {
    const int words = fields.words();
    to[k] = fields.at(list[k / words], k % words);
  }
};
/// Copies the rows of a message to row `first` and those behind it; for each of its words.
struct UnpackRowsPass {
  RowFields fields;
  const std::uint32_t* from;
  int first;
  PBF_HD void operator()(int k) const {
    const int words = fields.words();
    fields.at(first + k / words, k % words) = from[k];
  }
};

/// A message of which the sender alone knows the number of rows: words before the rows, of which
/// the first is the number.
inline constexpr int kHeadWords = 4;
/// For the words of a message with room for some rows.
struct PackCountedPass {
  PackRowsPass rows;
  const int* count;
  PBF_HD void operator()(int k) const {
    if (k == 0) rows.to[-kHeadWords] = std::uint32_t(*count);
    if (k < *count * rows.fields.words()) rows(k);
  }
};
/// The same for what has arrived. Room that is left over becomes rows without a bin.
struct UnpackCountedPass {
  UnpackRowsPass rows;
  int* bin;
  PBF_HD void operator()(int k) const {
    const int words = rows.fields.words();
    if (k < int(rows.from[-kHeadWords]) * words)
      rows(k);
    else if (k % words == 0)
      bin[rows.first + k / words] = -1;
  }
};

/// Rows that the next sort leaves out.
struct WithoutBinPass {
  int* bin;
  PBF_HD void operator()(int i) const { bin[i] = -1; }
};

/// A gather of a sort that counts what the prediction of own rows counts, and nothing of ghosts.
template <class Gather>
struct GatherOwnPass {
  Gather gather;
  const int *first, *last;  ///< own rows after the sort
  StepCounts* not_counted;
  PBF_HD void operator()(int from, int to) const {
    Gather g = gather;
    if (to < *first || to >= *last) g.counts = not_counted, g.order.damping = {};
    g(from, to);
  }
};

template <class Real>
struct LayerPass {
  Params<Real> p;
  const Vec4<Real>* position;
  PBF_HD int operator()(int i) const {
    return cell_coordinate(position[i].z, p.inv_cell, p.cells_z);
  }
};

/// The rows in a list are near no solid any more.
template <class Real>
struct LeaveNearPass {
  const int* row;
  Real* way;
  PBF_HD void operator()(int k) const { way[row[k]] = 0; }
};

}  // namespace pbf::PBF_VARIANT
