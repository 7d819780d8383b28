// A hierarchy of grids over the box, for corrections that reach farther than h (kernels/README.md,
// "Levels"). The cells of level 0 are 2 x 2 x 2 cells of the search grid (4 x 2 x 2 with its half
// cells along x), the last one of an axis longer or shorter, so that its end is the wall. Nodes are
// the corners; every level has every other node of the one before.
#pragma once

#include <cstdint>

#include "kernels/params.h"

namespace pbf {

/// Numbers of a node or a cell along x, y, z.
struct GridPlace {
  int k[3];
  PBF_HD int operator[](int axis) const { return k[axis]; }
};
PBF_HD GridPlace place_of(int n, const int (&of)[3]) {
  return {{n % of[0], n / of[0] % of[1], n / of[0] / of[1]}};
}

/// One level: where its nodes stand in arrays that hold those of all levels, and how many. A single
/// one along an axis lies under a hat that is constant.
struct LevelShape {
  int first = 0;
  int nodes[3] = {1, 1, 1};

  PBF_HD int size() const { return nodes[0] * nodes[1] * nodes[2]; }
  PBF_HD int at(int x, int y, int z) const { return first + (z * nodes[1] + y) * nodes[0] + x; }
  /// Of the n-th node of this level.
  PBF_HD GridPlace place(int n) const { return place_of(n, nodes); }
};

/// Cells of the finest level, and what they hold at rest. Lengths in h.
struct LevelCells {
  int cells[3] = {1, 1, 1};
  double edge = 2;             ///< of a cell
  double last[3] = {2, 2, 2};  ///< of the last one along each axis
  double half_full = 32;       ///< particles in half a cell of edge^3 (edge^2) at rest

  PBF_HD int size() const { return cells[0] * cells[1] * cells[2]; }
  PBF_HD GridPlace place(int c) const { return place_of(c, cells); }
  PBF_HD double length(int axis, int i) const { return i + 1 == cells[axis] ? last[axis] : edge; }
  /// Particles in half of that cell at rest.
  PBF_HD double half(GridPlace at) const {
    double n = half_full;
    for (int k = 0; k < 3; ++k) n *= length(k, at[k]) / edge;
    return n;
  }
};

/// The finest level first. An axis has fewer than 2^28 cells, and each level halves them.
struct LevelHierarchy {
  static constexpr int most = 32;
  int count = 0;
  LevelShape level[most];

  /// The level of a node of all.
  PBF_HD int of(int node) const {
    int l = 0;
    while (l + 1 < count && node >= level[l + 1].first) ++l;
    return l;
  }
  /// Ends of an axis that the hat of its i-th node on level l lies over: 1 the low, 2 the high one.
  PBF_HD unsigned ends(int l, int axis, int i) const {
    const int last = level[0].nodes[axis] - 1;  // 0: the axis that a plane has not
    return last == 0 ? 0u : (i == 0 ? 1u : 0u) | (last < (i + 1) << l ? 2u : 0u);
  }
};

/// f(x, y, z) for the places from `low` to before `end`, until it is true: those of the lane-th of
/// `of` threads, which share rows first.
template <class F>
PBF_HD void for_box(GridPlace low, GridPlace end, int lane, int of, F&& f) {
  int side_by_side = 1;
  while (side_by_side < of && side_by_side < end[0] - low[0]) side_by_side *= 2;
  int z = low[2];
  for (int y = low[1] + lane / side_by_side;; y += of / side_by_side) {
    for (; y >= end[1]; y -= end[1] - low[1])
      if (++z >= end[2]) return;
    for (int x = low[0] + lane % side_by_side; x < end[0]; x += side_by_side)
      if (f(x, y, z)) return;
  }
}

/// What lies under a hat along an axis, and its weights.
struct HatSpan {
  static constexpr int bits = 6;  ///< behind the point of a weight: exact up to an edge of 64

  int first, end;
  int offset, top;
  unsigned slope;  ///< 2^-24

  PBF_HD int weight(int i) const {
    const int away = 2 * i + offset;
    return top - int(unsigned(away < 0 ? -away : away) * slope >> 24);
  }
};

/// What the sums at nodes are made of: the cells, or the nodes of a level.
struct LevelSource {
  LevelShape grid;  ///< the cells: as many nodes, the first being 0
  bool cells;
  int level;  ///< of the nodes; 0 with cells
  const std::int64_t* value;

  /// Under the hat of node i of a coarser level l (0 and up with cells): the linear one over nodes;
  /// over cells the sum of those at their two ends. One is 2^bits.
  PBF_HD HatSpan under(const LevelShape& coarse, int l, int axis, int i) const {
    const int wide = l - level, edge = 1 << wide, middle = i << wide;
    return {max2(middle - edge + !cells, 0), min2(middle + edge, grid.nodes[axis]),
            cells - 2 * middle, 1 << (HatSpan::bits + cells),
            coarse.nodes[axis] == 1 ? 0u : 1u << (24 + HatSpan::bits) >> (wide + !cells)};
  }
};

/// Sums over cells and nodes are whole numbers, so that no order of summation shows: of clipped C
/// in these units, of particles in the other. 2^33 particles fit; into a cell 80 000 at the clip.
inline constexpr double kExcessUnit = 1.0 / (1 << 30), kCountUnit = 1.0 / (1 << 20);

/// Sums at the nodes of levels from .. to - 1. Its items are those nodes, the coarsest first: they
/// have most to add, so many threads share them.
struct LevelSums {
  LevelHierarchy all;
  int from, to;
  LevelSource source;

  PBF_HD int end() const { return all.level[to - 1].first + all.level[to - 1].size(); }
  PBF_HD int items() const { return end() - all.level[from].first; }
  PBF_HD int node(int item) const { return end() - 1 - item; }

  /// Groups of items that the same number of threads share.
  PBF_HD int groups() const { return to - from; }
  PBF_HD int size(int group) const { return all.level[to - 1 - group].size(); }
  /// 8, 64, 512, ... terms. many: all that can add up together.
  PBF_HD int lanes(int group, int many) const {
    const int wide = to - 1 - group - source.level;
    return wide == 0 ? 1 : wide == 1 ? 8 : wide == 2 ? 32 : many;
  }

  /// f(value, weight) for what lies under the hat of a node, until it is true: the share of the
  /// lane-th thread.
  template <class F>
  PBF_HD void for_terms(int node, int lane, int of, F&& f) const {
    const int l = all.of(node);
    const LevelShape& level = all.level[l];
    const GridPlace at = level.place(node - level.first);
    const HatSpan x = source.under(level, l, 0, at[0]), y = source.under(level, l, 1, at[1]),
                  z = source.under(level, l, 2, at[2]);
    for_box(
        {{x.first, y.first, z.first}}, {{x.end, y.end, z.end}}, lane, of, [&](int i, int j, int k) {
          return f(source.value[source.grid.at(i, j, k)], y.weight(j) * z.weight(k) * x.weight(i));
        });
  }
  /// Rounded for each term, so that it does not matter who adds it.
  PBF_HD static std::int64_t term(std::int64_t value, int weight) {
    return value * weight >> 3 * HatSpan::bits;
  }
};

}  // namespace pbf
