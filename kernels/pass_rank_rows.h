// Rows that change ranks, and copies of rows for adjacent ranks (lib/exec/ranks/rank_rows.h).
#pragma once

#include <cstdint>

#include "kernels/atomics.h"
#include "kernels/cell_index.h"
#include "kernels/params.h"

namespace pbf::PBF_VARIANT {

/// The ranks that need a row: that of its layer of cells, and those of the adjacent layers.
template <class Real>
struct RanksOfRow {
  Params<Real> p;
  const Vec4<Real>* position;
  const int* owner;  ///< rank of each layer

  struct Span {
    int low, high;
    PBF_HD bool has(int rank) const { return low <= rank && rank <= high; }
  };
  PBF_HD Span operator()(int i) const {
    const int layer = cell_coordinate(position[i].z, p.inv_cell, p.cells_z);
    return {owner[layer > 0 ? layer - 1 : 0],
            owner[layer + 1 < p.cells_z ? layer + 1 : p.cells_z - 1]};
  }
};

/// Lists the rows for each other rank; beyond `room` it only counts.
template <class Real>
struct SelectRowsPass {
  RanksOfRow<Real> ranks;
  int me;
  int* list;   ///< of each rank: `room` rows
  int* count;  ///< of each rank
  int room;
  PBF_HD void operator()(int i) const {
    const auto to = ranks(i);
    if (to.has(me - 1)) add(i, me - 1, take_place(count + me - 1));
    if (to.has(me + 1)) add(i, me + 1, take_place(count + me + 1));
    for (int r = to.low; r <= to.high; ++r)
      if (r < me - 1 || r > me + 1) add(i, r, take_place_of(count + r));
  }
  PBF_HD void add(int i, int rank, int place) const {
    if (place < room) list[std::int64_t(rank) * room + place] = i;
  }
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

/// Rows that do not belong here from the next sort on get a negative id: of the listed ones, those
/// that leave. A row may be in several lists.
template <class Real>
struct LeaveListedPass {
  RanksOfRow<Real> ranks;
  int me;
  const int* list;
  int* id;
  PBF_HD void operator()(int k) const {
    const int i = list[k];
    if (id[i] >= 0 && !ranks(i).has(me)) id[i] = -1 - id[i];
  }
};
/// The rows of other ranks.
struct LeaveGhostsPass {
  int* id;
  PBF_HD void operator()(int i) const { id[i] = -1 - id[i]; }
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
