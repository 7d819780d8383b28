// A hierarchy of grids over the box, for corrections that reach farther than h (kernels/README.md,
// "Levels"). The cells of level 0 are 2 x 2 x 2 cells of the search grid (4 x 2 x 2 with its half
// cells along x), the last one of an axis longer or shorter, so that its end is the wall. Nodes are
// the corners; every level has every other node of the one before.
#pragma once

#include <cstdint>

#include "kernels/params.h"

namespace pbf {

/// How an axis of a level follows from that of the finer one.
enum class Coarsened { first, halved, folded, kept };  ///< folded: two nodes become one

/// Numbers of a node or a cell along x, y, z.
struct GridPlace {
  int k[3];
  PBF_HD int operator[](int axis) const { return k[axis]; }
};
PBF_HD GridPlace place_of(int n, const int (&of)[3]) {
  return {{n % of[0], n / of[0] % of[1], n / of[0] / of[1]}};
}

/// One level: where its nodes stand in arrays that hold those of all levels, and how many.
struct LevelShape {
  int first = 0;
  int nodes[3] = {1, 1, 1};
  Coarsened from[3] = {Coarsened::first, Coarsened::first, Coarsened::first};

  PBF_HD int size() const { return nodes[0] * nodes[1] * nodes[2]; }
  PBF_HD int at(int x, int y, int z) const { return first + (z * nodes[1] + y) * nodes[0] + x; }
  /// Of the n-th node of this level.
  PBF_HD GridPlace place(int n) const { return place_of(n, nodes); }
};

/// The finest level, and what its cells hold at rest. Lengths in h.
struct LevelCells {
  int cells[3] = {1, 1, 1};
  double edge = 2;             ///< of a cell
  double last[3] = {2, 2, 2};  ///< of the last one along each axis
  double half_full = 32;       ///< particles in half a cell of edge^3 (edge^2) at rest

  PBF_HD int size() const { return cells[0] * cells[1] * cells[2]; }
  PBF_HD int at(int x, int y, int z) const { return (z * cells[1] + y) * cells[0] + x; }
  PBF_HD GridPlace place(int c) const { return place_of(c, cells); }
  PBF_HD double length(int axis, int i) const { return i + 1 == cells[axis] ? last[axis] : edge; }
  /// Particles in half of that cell at rest.
  PBF_HD double half(int x, int y, int z) const {
    return half_full * (length(0, x) / edge) * (length(1, y) / edge) * (length(2, z) / edge);
  }
};

/// The finest level first. An axis has fewer than 2^30 cells, and each level halves them.
struct LevelHierarchy {
  static constexpr int most = 32;
  int count = 0;
  LevelShape level[most];
};

/// A node of another level and its weight, in halves along one axis; 0: there is none.
struct Tap {
  int node, halves;
};
/// Of a coarse node i, the finer level's nodes d = 0, 1, 2; n of them along the axis.
PBF_HD Tap finer_node(Coarsened from, int i, int d, int n) {
  if (from == Coarsened::halved) {
    const int node = 2 * i + d - 1;
    return node >= 0 && node < n ? Tap{node, d == 1 ? 2 : 1} : Tap{0, 0};
  }
  return d == 0 || (d == 1 && from == Coarsened::folded) ? Tap{d, 2} : Tap{0, 0};
}
/// f(node, weight in eighths) for the nodes of `fine` under node `at` of `level`: every of-th of
/// them, from the lane-th on.
template <class F>
PBF_HD void for_finer_nodes(const LevelShape& fine, const LevelShape& level, GridPlace at, int lane,
                            int of, F&& f) {
  for (int n = lane; n < 27; n += of) {
    const Tap x = finer_node(level.from[0], at[0], n % 3, fine.nodes[0]);
    const Tap y = finer_node(level.from[1], at[1], n / 3 % 3, fine.nodes[1]);
    const Tap z = finer_node(level.from[2], at[2], n / 9, fine.nodes[2]);
    const int eighths = x.halves * y.halves * z.halves;
    if (eighths > 0) f(fine.at(x.node, y.node, z.node), eighths);
  }
}
/// Sums over cells and nodes are whole numbers, so that no order of summation shows: of clipped C
/// in these units, of particles in the other. 2^33 particles fit.
inline constexpr double kExcessUnit = 1.0 / (1 << 30), kCountUnit = 1.0 / (1 << 20);

/// The particles around a node, in kCountUnit, and whether the node is on.
struct LevelCount {
  std::int64_t marked = 0;  ///< below 0: off, and of no other meaning

  PBF_HD static LevelCount of(std::int64_t n, bool on) { return {on ? n : -1}; }
  PBF_HD bool on() const { return marked >= 0; }
};

}  // namespace pbf
