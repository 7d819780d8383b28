// A hierarchy of grids over the box, for corrections that reach farther than h (kernels/README.md,
// "Levels"). A cell of level 0 is 2 x 2 x 2 cells of the search grid (4 half cells along x). The
// last cell of an axis is longer or shorter, so that it ends at the wall. Nodes are the corners of
// cells; every coarser level has every other node of the level before.
#pragma once

#include <cstdint>

#include "kernels/params.h"

namespace pbf {

/// Indices of a node or a cell along x, y, z.
struct GridPlace {
  int k[3];
  PBF_HD int operator[](int axis) const { return k[axis]; }
};
PBF_HD GridPlace place_of(int n, const int (&of)[3]) {
  return {{n % of[0], n / of[0] % of[1], n / of[0] / of[1]}};
}

/// One level: the index of its first node in arrays over the nodes of all levels, and its numbers
/// of nodes. With one node along an axis, its hat is constant along that axis.
struct LevelShape {
  int first = 0;
  int nodes[3] = {1, 1, 1};

  PBF_HD int size() const { return nodes[0] * nodes[1] * nodes[2]; }
  PBF_HD int at(int x, int y, int z) const { return first + (z * nodes[1] + y) * nodes[0] + x; }
  /// Indices of the n-th node of this level.
  PBF_HD GridPlace place(int n) const { return place_of(n, nodes); }
};

/// Cells of the finest level, and how many particles they hold at rest. Lengths in h.
struct LevelCells {
  int cells[3] = {1, 1, 1};
  double edge = 2;              ///< of a cell
  double last[3] = {2, 2, 2};   ///< of the last one along each axis
  double share[3] = {1, 1, 1};  ///< last/edge
  double half_full = 32;        ///< particles in half a cell of edge^3 (2-D: edge^2) at rest

  PBF_HD int size() const { return cells[0] * cells[1] * cells[2]; }
  PBF_HD GridPlace place(int c) const { return place_of(c, cells); }
  PBF_HD int at(GridPlace c) const { return (c[2] * cells[1] + c[1]) * cells[0] + c[0]; }
  PBF_HD bool has(GridPlace c) const {
    return c[0] < cells[0] && c[1] < cells[1] && c[2] < cells[2];
  }
  PBF_HD double length(int axis, int i) const { return i + 1 == cells[axis] ? last[axis] : edge; }
  /// Bricks of 4 x 4 x 4 cells; the last ones may extend beyond the box.
  PBF_HD int bricks(int axis) const { return (cells[axis] + 3) / 4; }
  PBF_HD int bricks() const { return bricks(0) * bricks(1) * bricks(2); }
  /// Rows of the search grid along y or z: two for a cell, up to three for the last one.
  PBF_HD int rows(int axis) const { return 2 * cells[axis] + 1; }
  /// Number of entries for runs. A run is the particles of one cell in one row, adjacent in memory.
  /// One more entry per row marks its end.
  PBF_HD int runs(int dimensions) const {
    return (dimensions == 2 ? 1 : rows(1)) * rows(2) * (cells[0] + 1);
  }
  /// Half the number of particles that this cell holds at rest.
  PBF_HD double half(GridPlace at) const {
    double n = half_full;
    for (int k = 0; k < 3; ++k) n *= at[k] + 1 == cells[k] ? share[k] : 1;
    return n;
  }
};

/// The finest level first. An axis has fewer than 2^28 cells, and each level halves them.
struct LevelHierarchy {
  static constexpr int most = 32;
  int count = 0;
  LevelShape level[most];

  /// The level of a node, from its index over all levels.
  PBF_HD int of(int node) const {
    int l = 0;
    while (l + 1 < count && node >= level[l + 1].first) ++l;
    return l;
  }
  /// Ends of an axis that the hat of its i-th node on level l reaches, as bits: 1 low, 2 high.
  PBF_HD unsigned ends(int l, int axis, int i) const {
    const int last = level[0].nodes[axis] - 1;  // 0: the missing axis in two dimensions
    return last == 0 ? 0u : (i == 0 ? 1u : 0u) | (last < (i + 1) << l ? 2u : 0u);
  }
};

/// Calls f(x, y, z) for the places of a box, `end` excluded, until it returns true: the share of
/// thread `lane` of `of` threads, which are spread along x first.
template <class F>
PBF_HD void for_box(GridPlace low, GridPlace end, int lane, int of, F&& f) {
  int bits = 0;  // 2^bits threads along x
  while (1 << bits < of && 1 << bits < end[0] - low[0]) ++bits;
  int z = low[2];
  for (int y = low[1] + (lane >> bits);; y += of >> bits) {
    for (; y >= end[1]; y -= end[1] - low[1])
      if (++z >= end[2]) return;
    for (int x = low[0] + lane % (1 << bits); x < end[0]; x += 1 << bits)
      if (f(x, y, z)) return;
  }
}

/// The n-th place of a box, without divisions.
struct BoxPlaces {
  GridPlace low;
  unsigned wide, high, by_wide, by_high;
  int count;

  PBF_HD BoxPlaces(GridPlace first, GridPlace end)
      : low(first),
        wide(unsigned(end[0] - low[0])),
        high(unsigned(end[1] - low[1])),
        by_wide(~0u / wide),
        by_high(~0u / high),
        count(int(wide * high) * (end[2] - low[2])) {}
  PBF_HD GridPlace operator()(int n) const {
    const unsigned row = over(unsigned(n), wide, by_wide), layer = over(row, high, by_high);
    return {{low[0] + int(unsigned(n) - row * wide), low[1] + int(row - layer * high),
             low[2] + int(layer)}};
  }

 private:
  /// n / by for n < 2^31; the product with the inverse is at most 1 too small.
  PBF_HD static unsigned over(unsigned n, unsigned by, unsigned inverse) {
    const auto q = unsigned(std::uint64_t(n) * inverse >> 32);
    return q + (n - q * by >= by ? 1u : 0u);
  }
};

/// The cells or corners under a hat along one axis, and their weights.
struct HatSpan {
  static constexpr int bits = 6;  ///< fractional bits of a weight; exact up to 64 bricks

  int first, end;
  bool cells;
  int middle, top;
  unsigned slope;  ///< in units of 2^-24

  /// In doubled coordinates, cell i is at 2 i + 1; the two brick corners at a node coincide.
  PBF_HD int weight(int i) const {
    const int away = (cells ? 2 * i + 1 : (i + 1) / 2 * 2) - middle;
    return top - int(unsigned(away < 0 ? -away : away) * slope >> 24);
  }
};

/// The terms of the sums at nodes: cells for levels 0 and 1; for coarser levels, whose hats are
/// linear within a brick, the sums that the cells of a brick give to its 8 corners.
struct LevelSource {
  LevelShape grid;  ///< the cells, or the corners: 2 per brick along an axis
  bool cells;
  const std::int64_t* value;

  /// What is under the hat of node i of level l. The weight of a corner is the hat there, that of a
  /// cell the sum of the hat at its two ends. 2^bits stands for 1.
  PBF_HD HatSpan under(const LevelShape& level, int l, int axis, int i) const {
    const bool one = level.nodes[axis] == 1;
    const int wide = cells ? l : l - 2, edge = 1 << wide, middle = i << wide;
    const int first = cells ? middle - edge : 2 * (middle - edge) + 1;
    const int end = cells ? middle + edge : 2 * (middle + edge) - 1 + one;
    return {max2(first, 0),
            min2(end, grid.nodes[axis]),
            cells,
            2 * middle,
            1 << (HatSpan::bits + cells),
            one ? 0u : 1u << (24 + HatSpan::bits) >> (wide + !cells)};
  }
};

/// Units of the sums over cells and nodes: of clipped C, and of particle counts. The sums are
/// integers, so their order does not matter. 2^33 particles fit, and 10 000 at the clip in a cell.
inline constexpr double kExcessUnit = 1.0 / (1 << 30), kCountUnit = 1.0 / (1 << 20);

/// Sums at the nodes of all levels. Items are the nodes, the coarsest first: these have the most
/// terms, so many threads share one.
struct LevelSums {
  LevelHierarchy all;
  LevelSource cells, corners;

  PBF_HD int items() const { return all.level[all.count - 1].first + size(0); }
  PBF_HD int node(int item) const { return items() - 1 - item; }

  /// Groups of items, one per level; equally many threads share each item of a group.
  PBF_HD int groups() const { return all.count; }
  PBF_HD int size(int group) const { return all.level[all.count - 1 - group].size(); }
  /// Terms by level: 8, 64 cells; 8, 216, ... corners. many: the most threads that can add up.
  PBF_HD int lanes(int group, int many) const {
    const int l = all.count - 1 - group;
    if (l == 1) return size(group) < 1 << 14 ? 8 : 4;
    return l < 3 ? 1 : l < 5 ? 32 : many;
  }

  /// Calls f(value, weight) for what is under the hat of a node, until it returns true: the share
  /// of thread `lane` of `of` threads.
  template <class F>
  PBF_HD void for_terms(int node, int lane, int of, F&& f) const {
    const int l = all.of(node);
    const LevelShape& level = all.level[l];
    const LevelSource from = l < 2 ? cells : corners;
    const GridPlace at = level.place(node - level.first);
    if (l == 0) return lane == 0 ? for_cells_around(at, f) : void();
    const HatSpan x = from.under(level, l, 0, at[0]), y = from.under(level, l, 1, at[1]),
                  z = from.under(level, l, 2, at[2]);
    const GridPlace low{{x.first, y.first, z.first}}, end{{x.end, y.end, z.end}};
    const BoxPlaces places(low, end);
    if (of == 1 && places.count > at_once) {
      for_box(low, end, 0, 1, [&](int i, int j, int k) {
        return f(from.value[from.grid.at(i, j, k)], y.weight(j) * z.weight(k) * x.weight(i));
      });
      return;
    }
    bool stop = false;
    for (int first = lane; first < places.count && !stop; first += at_once * of) {
      std::int64_t value[at_once];
      int weight[at_once];
      for (int n = 0; n < at_once; ++n) {
        const bool there = first + n * of < places.count;
        const GridPlace p = places(first + n * of);
        value[n] = there ? from.value[from.grid.at(p[0], p[1], p[2])] : 0;
        weight[n] = y.weight(p[1]) * z.weight(p[2]) * x.weight(p[0]);
      }
      for (int n = 0; n < at_once; ++n) stop = f(value[n], weight[n]) || stop;
    }
  }

  static constexpr int at_once = 8;  ///< loads that are issued together

  /// The same for a node of level 0.
  template <class F>
  PBF_HD void for_cells_around(GridPlace at, F&& f) const {
    std::int64_t value[8];
    int weight = 1 << 3 * HatSpan::bits;
    for (int k = 0; k < 3; ++k) weight <<= all.level[0].nodes[k] == 1;
    for (int m = 0; m < 8; ++m) {
      const GridPlace c{{at[0] - 1 + (m & 1), at[1] - 1 + (m >> 1 & 1), at[2] - 1 + (m >> 2)}};
      const bool there = c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < cells.grid.nodes[0] &&
                         c[1] < cells.grid.nodes[1] && c[2] < cells.grid.nodes[2];
      value[m] = there ? cells.value[cells.grid.at(c[0], c[1], c[2])] : 0;
    }
    for (int m = 0; m < 8; ++m) f(value[m], weight);
  }
  /// Rounded per term, so it does not matter which thread adds it.
  PBF_HD static std::int64_t term(std::int64_t value, int weight) {
    return value * weight >> 3 * HatSpan::bits;
  }
};

/// A partial sum: numbers are added, bits combined by or.
struct LevelPart {
  std::int64_t number, bits;

  PBF_HD LevelPart& operator+=(const LevelPart& other) {
    number += other.number;
    bits |= other.bits;
    return *this;
  }
};

/// Base of passes over bricks, which also give the value of each cell to the corners of its brick.
/// lanes: threads that share a cell.
template <int D>
struct LevelBrickPass {
  LevelCells grid;
  std::int64_t* corner;  ///< out, laid out as in LevelSource

  static constexpr int lanes = 4, brick_cells = D == 2 ? 16 : 64, brick_corners = 8;

  PBF_HD GridPlace brick(int n) const {
    const int of[3] = {grid.bricks(0), grid.bricks(1), grid.bricks(2)};
    return place_of(n, of);
  }
  /// The k-th cell of a brick; it may lie beyond the box.
  PBF_HD GridPlace cell(GridPlace b, int k) const {
    const GridPlace in = inside(k);
    return {{4 * b[0] + in[0], 4 * b[1] + in[1], 4 * b[2] + in[2]}};
  }
  /// What the k-th cell gives to a corner.
  PBF_HD LevelPart share(int which, int k, std::int64_t value) const {
    const GridPlace in = inside(k);
    int weight = 1;  // per axis in units of 1/128, so 16 is an eighth
    for (int a = 0; a < 3; ++a) weight *= 16 * (which >> a & 1 ? 2 * in[a] + 1 : 7 - 2 * in[a]);
    return {LevelSums::term(value, weight), value};
  }
  PBF_HD std::int64_t& at(GridPlace b, int which) const {
    const int x = 2 * b[0] + (which & 1), y = 2 * b[1] + (which >> 1 & 1);
    const int z = 2 * b[2] + (which >> 2);
    return corner[(z * 2 * grid.bricks(1) + y) * 2 * grid.bricks(0) + x];
  }

 private:
  PBF_HD static GridPlace inside(int k) {
    return D == 2 ? GridPlace{{k % 4, 0, k / 4}} : GridPlace{{k % 4, k / 4 % 4, k / 16}};
  }
};

}  // namespace pbf
