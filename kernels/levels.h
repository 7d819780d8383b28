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

/// One level: where its nodes stand in arrays that hold those of all levels, and how many.
struct LevelShape {
  int first = 0;
  int nodes[3] = {1, 1, 1};
  Coarsened from[3] = {Coarsened::first, Coarsened::first, Coarsened::first};

  PBF_HD int size() const { return nodes[0] * nodes[1] * nodes[2]; }
  PBF_HD int at(int x, int y, int z) const { return first + (z * nodes[1] + y) * nodes[0] + x; }
};

/// The finest level, and what its cells hold at rest. Lengths in h.
struct LevelCells {
  int cells[3] = {1, 1, 1};
  double edge = 2;             ///< of a cell
  double last[3] = {2, 2, 2};  ///< of the last one along each axis
  double half_full = 32;       ///< particles in half a cell of edge^3 (edge^2) at rest

  PBF_HD int size() const { return cells[0] * cells[1] * cells[2]; }
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
/// Of a fine node i, the coarser level's nodes d = 0, 1.
PBF_HD Tap coarser_node(Coarsened from, int i, int d) {
  if (from != Coarsened::halved) return {0, d == 0 ? 2 : 0};
  if (i % 2 == 0) return {i / 2, d == 0 ? 2 : 0};
  return {i / 2 + d, 1};
}

/// Sums of a cell or a node: of clipped C in units of 2^-30, of particles in units of 2^-20. Whole
/// numbers, so that no order of summation shows.
struct LevelSum {
  std::int64_t excess = 0, particles = 0;
  static constexpr double excess_unit = 1.0 / (1 << 30), particle_unit = 1.0 / (1 << 20);
};

}  // namespace pbf
