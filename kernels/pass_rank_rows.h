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

/// Lists the rows for `rank`; beyond `room` it only counts.
template <class Real>
struct SelectRowsPass {
  RanksOfRow<Real> ranks;
  int rank;
  int *list, *count;
  int room;
  PBF_HD void operator()(int i) const {
    if (!ranks(i).has(rank)) return;
    const int k = take_place(count);
    if (k < room) list[k] = i;
  }
};

/// Counts the rows that a rank beyond the adjacent ones needs.
template <class Real>
struct FarRowsPass {
  RanksOfRow<Real> ranks;
  int me;
  int* count;
  PBF_HD void operator()(int i) const {
    const auto span = ranks(i);
    if (span.low < me - 1 || span.high > me + 1) take_place(count);
  }
};

/// Copies listed rows of a field, as words of 4 bytes.
struct PackRowsPass {
  const std::uint32_t* from;
  const int* list;
  int words;  ///< of a row
  std::uint32_t* to;
  PBF_HD void operator()(int k) const {
    to[k] = from[std::int64_t(list[k / words]) * words + k % words];
  }
};

/// Rows that do not belong here from the next sort on get a negative id: those of other ranks, and
/// own ones that leave.
template <class Real>
struct LeaveRowsPass {
  RanksOfRow<Real> ranks;
  int me, first, last;  ///< own rows
  int* id;
  PBF_HD void operator()(int i) const {
    if (i < first || i >= last || !ranks(i).has(me)) id[i] = -1 - id[i];
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
