// Levels: what is made with the lists and lasts as long as they do. Who is in which cell, which
// nodes are on and how strongly they answer. kernels/README.md, "Levels".
//
// Passes with a type Part are shared by several threads where there are many: each adds up a part
// of the terms, whole numbers or bits, so that it does not matter who adds what.
#pragma once

#include "kernels/cell_index.h"
#include "kernels/levels.h"

namespace pbf::inline PBF_VARIANT {

/// f(i) for the sorted particles of a cell: every of-th in each of its rows, from the lane-th on.
template <int D, class Real, class F>
PBF_HD void for_particles_of_cell(const Params<Real>& p, const LevelCells& grid,
                                  const int* bin_start, int c, int lane, int of, F&& f) {
  const GridPlace cell = grid.place(c);
  const auto end = [&](int axis, int per_cell, int all) {
    return cell[axis] + 1 < grid.cells[axis] ? per_cell * (cell[axis] + 1) : all;
  };
  const int x1 = end(0, 4, p.cells_x), z1 = end(2, 2, p.cells_z);
  const int y0 = D == 2 ? 0 : 2 * cell[1], y1 = D == 2 ? 1 : end(1, 2, p.cells_y);
  for (int z = 2 * cell[2]; z < z1; ++z)
    for (int y = y0; y < y1; ++y) {
      const int row = (D == 2 ? z : z * p.cells_y + y) * p.cells_x;
      const int last = bin_start[(row + x1) * bins_per_cell(D)];
      for (int i = bin_start[(row + 4 * cell[0]) * bins_per_cell(D)] + lane; i < last; i += of)
        f(i);
    }
}

/// f(cell, x, y, z) for the cells that a node of level 0 is a corner of: the lane-th of eight, and
/// every of-th behind it.
template <class F>
PBF_HD void for_cells_around(const LevelCells& grid, GridPlace node, int lane, int of, F&& f) {
  for (int n = lane; n < 8; n += of) {
    const int x = node[0] - 1 + (n & 1), y = node[1] - 1 + (n >> 1 & 1), z = node[2] - 1 + (n >> 2);
    if (x >= 0 && y >= 0 && z >= 0 && x < grid.cells[0] && y < grid.cells[1] && z < grid.cells[2])
      f(grid.at(x, y, z), x, y, z);
  }
}

/// The cell of each particle, and how many there are in it.
template <class Real, int D>
struct LevelHomePass {
  Params<Real> p;
  LevelCells grid;
  const int* bin_start;
  const Vec4<Real>* position;  ///< null where no face is open; those beyond are in no cell
  int* home;                   ///< out; -1: in no cell
  int* count;                  ///< out, of each cell

  static constexpr int lanes = 8;
  using Part = int;
  PBF_HD Part part(int c, int lane, int of) const {
    int inside = 0;
    for_particles_of_cell<D>(p, grid, bin_start, c, lane, of, [&](int i) {
      const bool in = !position || p.boundary.inside(xyz(position[i]));
      home[i] = in ? c : -1;
      inside += in;
    });
    return inside;
  }
  PBF_HD void finish(int c, Part inside) const { count[c] = inside; }
};

/// What is known of the nodes while the lists last. Of each: the particles around it; what it makes
/// of the sum of C around it, multiplier = answer * sum (0 where it is off); and, as bits, the axes
/// with a wall that the fluid around it stands against, as far as the nodes that are on reach.
template <class Real>
struct LevelNodes {
  LevelCount* count;
  Real* answer;
  int* walls;

  PBF_HD void set(int n, LevelCount around, double stiffness, int against) const {
    count[n] = around;
    answer[n] = around.marked > 0
                    ? Real(stiffness * kExcessUnit / (double(around.marked) * kCountUnit))
                    : Real(0);
    walls[n] = around.on() ? against : 0;
  }
};

/// What threads that share a node add up.
struct LevelPart {
  std::int64_t number = 0;
  int off = 0, walls = 0;  ///< walls: bits

  PBF_HD LevelPart& operator+=(const LevelPart& other) {
    number += other.number;
    off |= other.off;
    walls |= other.walls;
    return *this;
  }
};

/// A node of level 0: the particles in the cells around it. Off where one of them is not half full
/// or beyond an open face: a hat must not reach into the air.
template <class Real>
struct LevelNodePass {
  unsigned closed;  ///< Box::walls
  LevelCells grid;
  LevelShape level;
  double stiffness;
  const int* count;
  LevelNodes<Real> node;  ///< out

  static constexpr int lanes = 2;
  using Part = LevelPart;
  PBF_HD Part part(int n, int lane, int of) const {
    Part sum;
    for_cells_around(grid, level.place(n), lane, of, [&](int cell, int x, int y, int z) {
      sum.number += count[cell];
      sum.off |= count[cell] < grid.half(x, y, z);
    });
    return sum;
  }
  PBF_HD void finish(int n, const Part& sum) const {
    const GridPlace at = level.place(n);
    bool on = !sum.off;
    int walls = 0;
    for (int k = 0; k < 3; ++k) {
      if (level.nodes[k] == 1) continue;  // the axis that a plane has not
      const bool low = at[k] == 0, high = at[k] == grid.cells[k];
      if (low || high) walls |= 1 << k;
      on = on && !(low && !(closed & (1u << (2 * k)))) && !(high && !(closed & (2u << (2 * k))));
    }
    node.set(n, LevelCount::of(sum.number << 20, on), stiffness, walls);
  }
};

/// A node of a coarser level: the finer ones around it, weights 1 and 1/2 along each axis; off
/// where one of them is.
template <class Real>
struct LevelCoarserPass {
  LevelShape fine, level;
  double stiffness;
  LevelNodes<Real> node;  ///< in: fine; out: level

  static constexpr int lanes = 8;
  using Part = LevelPart;
  PBF_HD Part part(int n, int lane, int of) const {
    Part sum;
    for_finer_nodes(fine, level, level.place(n), lane, of, [&](int finer, int eighths) {
      const LevelCount c = node.count[finer];
      sum.off |= !c.on();
      sum.number += eighths * c.marked;
      sum.walls |= node.walls[finer];
    });
    return sum;
  }
  PBF_HD void finish(int n, const Part& sum) const {
    node.set(level.first + n, LevelCount::of(sum.number >> 3, !sum.off), stiffness, sum.walls);
  }
};

/// The walls of a node are also those of the coarser ones whose hats overlap with its own.
template <class Real>
struct LevelWallsPass {
  LevelShape level, coarse;
  LevelNodes<Real> node;  ///< in: coarse; in/out: level

  PBF_HD void operator()(int n) const {
    const GridPlace at = level.place(n);
    int low[3], high[3], walls = node.walls[level.first + n];
    for (int k = 0; k < 3; ++k) {
      const bool halved = coarse.from[k] == Coarsened::halved;
      low[k] = halved ? max2((at[k] - 1) / 2, 0) : 0;
      high[k] = halved ? min2(at[k] / 2 + 1, coarse.nodes[k] - 1) : 0;
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) walls |= node.walls[coarse.at(x, y, z)];
    node.walls[level.first + n] = walls;
  }
};

/// Steps over levels that are small: from `first` down to the coarsest and up again, each made of
/// the one before.
struct LevelSteps {
  LevelHierarchy all;
  int first;

  PBF_HD int down() const { return all.count - first; }
  PBF_HD int steps() const { return 2 * down(); }
  /// Steps that threads share.
  PBF_HD bool shared(int step) const { return step < down(); }
  PBF_HD int level_of(int step) const {
    return shared(step) ? first + step : all.count - 1 - (step - down());
  }
  PBF_HD int size(int step) const { return all.level[level_of(step)].size(); }
  /// The next coarser one; of the coarsest itself.
  PBF_HD const LevelShape& coarser_than(int k) const {
    return all.level[k + 1 < all.count ? k + 1 : k];
  }
};

/// What is known of the nodes of those levels.
template <class Real>
struct LevelNodeChain : LevelSteps {
  double stiffness;  ///< of level 0; four times as large on each coarser one
  LevelNodes<Real> node;

  PBF_HD LevelCoarserPass<Real> coarser(int k) const {
    double s = stiffness;
    for (int l = 0; l < k; ++l) s *= 4;
    return {all.level[k - 1], all.level[k], s, node};
  }
  PBF_HD LevelWallsPass<Real> walls(int k) const { return {all.level[k], coarser_than(k), node}; }

  static constexpr int lanes = 32;
  using Part = LevelPart;
  PBF_HD Part part(int step, int n, int lane, int of) const {
    return coarser(level_of(step)).part(n, lane, of);
  }
  PBF_HD void finish(int step, int n, const Part& sum) const {
    coarser(level_of(step)).finish(n, sum);
  }
  PBF_HD void operator()(int step, int n) const {
    if (level_of(step) + 1 < all.count) walls(level_of(step))(n);
  }
};

}  // namespace pbf::inline PBF_VARIANT
