// Levels: the passes over cells and nodes, and the displacement of a particle. Two kinds: those
// that are made with the lists (who is in which cell, which nodes are on and how strongly they
// answer), and those of an iteration. kernels/README.md, "Levels".
#pragma once

#include "kernels/cell_index.h"
#include "kernels/levels.h"

namespace pbf::inline PBF_VARIANT {

/// C counts up to here in the mean of a cell: else a few particles in one place would push all
/// those around them.
inline constexpr double kLevelClip = 0.1;

/// A cell is summed in rows along x, one thread each.
template <int D>
constexpr int kRowsPerCell = D == 2 ? 2 : 4;

/// f(from, to) for the ranges of sorted particles that make up row n of the cells.
template <int D, class Real, class F>
PBF_HD void for_row_of_cell(const Params<Real>& p, const LevelCells& grid, const int* bin_start,
                            int n, F&& f) {
  const GridPlace cell = grid.place(n / kRowsPerCell<D>);
  const int part = n % kRowsPerCell<D>;
  const int x0 = 4 * cell[0], x1 = cell[0] + 1 < grid.cells[0] ? x0 + 4 : p.cells_x;
  // The first row of two, or the others: a last cell may have one or three.
  const auto rows = [](int at, int cells, int of, int second, int& from, int& to) {
    from = 2 * at + second;
    to = !second ? from + 1 : at + 1 < cells ? from + 1 : of;
  };
  int y0 = 0, y1 = 1, z0, z1;
  if constexpr (D == 3) rows(cell[1], grid.cells[1], p.cells_y, part / 2, y0, y1);
  rows(cell[2], grid.cells[2], p.cells_z, part % 2, z0, z1);
  for (int z = z0; z < z1; ++z)
    for (int y = y0; y < y1; ++y) {
      const int at = (D == 2 ? z : z * p.cells_y + y) * p.cells_x;
      f(bin_start[(at + x0) * bins_per_cell(D)], bin_start[(at + x1) * bins_per_cell(D)]);
    }
}

/// f(cell, x, y, z) for the cells that a node of level 0 is a corner of.
template <class F>
PBF_HD void for_cells_around(const LevelCells& grid, GridPlace node, F&& f) {
  int low[3], high[3];
  for (int k = 0; k < 3; ++k) {
    low[k] = node[k] > 0 ? node[k] - 1 : 0;
    high[k] = node[k] < grid.cells[k] ? node[k] : grid.cells[k] - 1;
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) f(grid.at(x, y, z), x, y, z);
}

/// The cell of each particle, and how many each row of a cell has.
template <class Real, int D>
struct LevelHomePass {
  Params<Real> p;
  LevelCells grid;
  const int* bin_start;
  const Vec4<Real>* position;  ///< null where no face is open; those beyond are in no cell
  int* home;                   ///< out; -1: in no cell
  int* count;                  ///< out, of each row

  PBF_HD void operator()(int n) const {
    int inside = 0;
    for_row_of_cell<D>(p, grid, bin_start, n, [&](int from, int to) {
      for (int i = from; i < to; ++i) {
        const bool in = !position || p.boundary.inside(xyz(position[i]));
        home[i] = in ? n / kRowsPerCell<D> : -1;
        inside += in;
      }
    });
    count[n] = inside;
  }
};

/// What a node makes of the sum of C around it: its multiplier is answer * sum, h^2 (unit).
template <class Real>
PBF_HD Real level_answer(LevelCount n, double stiffness) {
  return n.on() && n.number() > 0
             ? Real(stiffness * kExcessUnit / (double(n.number()) * kCountUnit))
             : Real(0);
}

/// What is known of the nodes while the lists last. Of each: the particles around it; what it
/// answers, 0 where it is off; and, as bits, the axes with a wall that the fluid around it stands
/// against, as far as the nodes that are on reach.
template <class Real>
struct LevelNodes {
  LevelCount* count;
  Real* answer;
  int* walls;
};

/// A node of level 0: the particles in the cells around it. Off where one of them is not half full
/// or beyond an open face: a hat must not reach into the air.
template <class Real, int D>
struct LevelNodePass {
  unsigned closed;  ///< Box::walls
  LevelCells grid;
  LevelShape level;
  double stiffness;
  const int* count;
  LevelNodes<Real> node;  ///< out

  PBF_HD void operator()(int n) const {
    const GridPlace at = level.place(n);
    bool on = true;
    int walls = 0;
    for (int k = 0; k < 3; ++k) {
      if (level.nodes[k] == 1) continue;  // the axis that a plane has not
      const bool low = at[k] == 0, high = at[k] == grid.cells[k];
      if (low || high) walls |= 1 << k;
      on = on && !(low && !(closed & (1u << (2 * k)))) && !(high && !(closed & (2u << (2 * k))));
    }
    std::int64_t all = 0;
    for_cells_around(grid, at, [&](int cell, int x, int y, int z) {
      int particles = 0;
      for (int r = 0; r < kRowsPerCell<D>; ++r) particles += count[cell * kRowsPerCell<D> + r];
      all += particles;
      on = on && particles >= grid.half(x, y, z);
    });
    node.count[n] = LevelCount::of(all << 20, on);
    node.answer[n] = level_answer<Real>(node.count[n], stiffness);
    node.walls[n] = on ? walls : 0;
  }
};

/// A node of a coarser level: the finer ones around it, weights 1 and 1/2 along each axis; off
/// where one of them is.
template <class Real>
struct LevelCoarserPass {
  LevelShape fine, level;
  double stiffness;
  LevelNodes<Real> node;  ///< in: fine; out: level

  PBF_HD void operator()(int n) const {
    std::int64_t eight = 0;
    bool on = true;
    int walls = 0;
    for_finer_nodes(fine, level, level.place(n), [&](int finer, int eighths) {
      const LevelCount c = node.count[finer];
      on = on && c.on();
      eight += eighths * c.number();
      walls |= node.walls[finer];
    });
    const LevelCount mine = LevelCount::of(eight >> 3, on);
    node.count[level.first + n] = mine;
    node.answer[level.first + n] = level_answer<Real>(mine, stiffness);
    node.walls[level.first + n] = on ? walls : 0;
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

/// Sums of C, signed and clipped, over the rows of cells.
template <class Real, int D>
struct LevelSumPass {
  Params<Real> p;
  LevelCells grid;
  const int* bin_start;
  const int* home;  ///< null where no face is open
  const Real* density;
  std::int64_t* row;  ///< out, in kExcessUnit

  PBF_HD void operator()(int n) const {
    std::int64_t sum = 0;
    for_row_of_cell<D>(p, grid, bin_start, n, [&](int from, int to) {
      if (!home)
        for (int i = from; i < to; ++i) sum += excess(density[i]);
      else
        for (int i = from; i < to; ++i) sum += home[i] >= 0 ? excess(density[i]) : 0;
    });
    row[n] = sum;
  }
  /// What is no number counts as the clip: the guard looks for it elsewhere.
  PBF_HD static int excess(Real density) {
    const Real c = max2(min2(density - Real(1), Real(kLevelClip)), Real(-1));
    return int(c * Real(1 << 30));
  }
};

/// The sums around the nodes of level 0 that are on.
template <class Real, int D>
struct LevelNodeSumPass {
  LevelCells grid;
  LevelShape level;
  const Real* answer;
  const std::int64_t* row;
  std::int64_t* sum;  ///< out

  PBF_HD void operator()(int n) const {
    std::int64_t s = 0;
    if (answer[n] != Real(0))
      for_cells_around(grid, level.place(n), [&](int cell, int, int, int) {
        for (int r = 0; r < kRowsPerCell<D>; ++r) s += row[cell * kRowsPerCell<D> + r];
      });
    sum[n] = s;
  }
};

/// The same of a coarser level.
template <class Real>
struct LevelCoarserSumPass {
  LevelShape fine, level;
  const Real* answer;
  std::int64_t* sum;  ///< in: fine; out: level

  PBF_HD void operator()(int n) const {
    std::int64_t eight = 0;
    if (answer[level.first + n] != Real(0))
      for_finer_nodes(fine, level, level.place(n),
                      [&](int finer, int eighths) { eight += eighths * sum[finer]; });
    sum[level.first + n] = eight >> 3;
  }
};

/// The multiplier of a node: its own, and what the coarser level says there.
template <class Real>
struct LevelMultiplierPass {
  LevelShape level, coarse;
  bool coarsest;
  const Real* answer;
  const std::int64_t* sum;
  Real* multiplier;  ///< in: coarse; out: level, h^2

  PBF_HD void operator()(int n) const {
    const std::int64_t s = sum[level.first + n];
    Real k = s > 0 ? answer[level.first + n] * Real(s) : Real(0);
    if (!coarsest)
      for_coarser_nodes(coarse, level.place(n), [&](int coarser, int eighths) {
        k += Real(eighths) * Real(0.125) * multiplier[coarser];
      });
    multiplier[level.first + n] = k;
  }
};

/// The displacement that the particles of a cell share: -gamma times the gradient of the multiplier
/// in its middle. Along an axis without a wall that could take it, the fluid must not get momentum:
/// there cells with fewer particles move them farther, so that what a hat does adds up to 0.
template <class Real, int D>
struct LevelMovePass {
  LevelCells grid;
  LevelShape level;
  Real gamma;
  const Real* multiplier;
  const int* walls;  ///< of nodes
  const int* count;
  Vec4<Real>* move;  ///< out, h

  PBF_HD void operator()(int c) const {
    const GridPlace at = grid.place(c);
    Real sum[3] = {};
    int against = 0, particles = 0;
    for (int n = 0; n < 8; ++n) {
      const int up[3] = {n & 1, n >> 1 & 1, n >> 2};
      if (D == 2 && up[1]) continue;
      const int node = level.at(at[0] + up[0], at[1] + up[1], at[2] + up[2]);
      const Real k = multiplier[node];
      for (int a = 0; a < 3; ++a) sum[a] += up[a] ? k : -k;
      against |= walls[node];
    }
    for (int r = 0; r < kRowsPerCell<D>; ++r) particles += count[c * kRowsPerCell<D> + r];
    for (int a = 0; a < 3; ++a) {
      if (D == 2 && a == 1) sum[a] = Real(0);
      sum[a] *= -gamma * Real(1 / ((D == 2 ? 2 : 4) * grid.length(a, at[a])));
      if (!(against >> a & 1) && particles > 0)
        sum[a] *= Real(2 * grid.half(at[0], at[1], at[2]) / particles);
    }
    move[c] = {sum[0], sum[1], sum[2], Real(0)};
  }
};

/// Steps of levels that are small: from `first` on, each made of the one before.
struct LevelSteps {
  LevelHierarchy all;
  int first;

  PBF_HD int down() const { return all.count - first; }
  /// Down to the coarsest and up again.
  PBF_HD int level_of(int step) const {
    return step < down() ? first + step : all.count - 1 - (step - down());
  }
  PBF_HD int size(int step) const { return all.level[level_of(step)].size(); }
};

/// What is known of those levels while the lists last.
template <class Real>
struct LevelNodeChain : LevelSteps {
  double stiffness;  ///< of level 0; four times as large on each coarser one
  LevelNodes<Real> node;

  /// The coarsest level has no coarser one to take walls from.
  PBF_HD int steps() const { return 2 * down(); }
  PBF_HD LevelCoarserPass<Real> coarser(int k) const {
    double s = stiffness;
    for (int l = 0; l < k; ++l) s *= 4;
    return {all.level[k - 1], all.level[k], s, node};
  }
  PBF_HD LevelWallsPass<Real> up(int k) const {
    return {all.level[k], all.level[k + 1 == all.count ? k : k + 1], node};
  }
  PBF_HD void operator()(int step, int n) const {
    const int k = level_of(step);
    if (step < down())
      coarser(k)(n);
    else if (k + 1 < all.count)
      up(k)(n);
  }
};

/// Their sums, then their multipliers.
template <class Real>
struct LevelChain : LevelSteps {
  const Real* answer;
  std::int64_t* sum;
  Real* multiplier;

  PBF_HD int steps() const { return 2 * down(); }
  PBF_HD LevelCoarserSumPass<Real> coarser(int k) const {
    return {all.level[k - 1], all.level[k], answer, sum};
  }
  PBF_HD LevelMultiplierPass<Real> up(int k) const {
    const bool coarsest = k + 1 == all.count;
    return {all.level[k], all.level[coarsest ? k : k + 1], coarsest, answer, sum, multiplier};
  }
  PBF_HD void operator()(int step, int n) const {
    const int k = level_of(step);
    step < down() ? coarser(k)(n) : up(k)(n);
  }
};

/// What a particle is moved by.
template <class Real>
struct LevelMove {
  static constexpr bool on = true;
  const int* home;
  const Vec4<Real>* move;

  PBF_HD Vec3<Real> operator()(int i) const {
    return home[i] >= 0 ? xyz(move[home[i]]) : Vec3<Real>{};
  }
};
/// No levels: nothing to move, nothing to carry.
template <class Real>
struct NoLevelMove {
  static constexpr bool on = false;
};

}  // namespace pbf::inline PBF_VARIANT
