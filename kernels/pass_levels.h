// Levels, in an iteration: sums of C over cells and nodes, the multipliers of the nodes, and the
// displacement that follows from them. kernels/README.md, "Levels".
#pragma once

#include "kernels/pass_level_cells.h"

namespace pbf::inline PBF_VARIANT {

/// C counts up to here in the mean of a cell: else a few particles in one place would push all
/// those around them.
inline constexpr double kLevelClip = 0.1;

/// Sums of C, signed and clipped, over the cells.
template <class Real, int D>
struct LevelSumPass {
  Params<Real> p;
  LevelCells grid;
  const int* bin_start;
  const int* home;  ///< null where no face is open
  const Real* density;
  std::int64_t* cell;  ///< out, in kExcessUnit

  static constexpr int lanes = 16;
  using Part = std::int64_t;
  PBF_HD Part part(int c, int lane, int of) const {
    Part sum = 0;
    if (home)
      for_particles_of_cell<D>(p, grid, bin_start, c, lane, of,
                               [&](int i) { sum += home[i] >= 0 ? excess(density[i]) : 0; });
    else
      for_particles_of_cell<D>(p, grid, bin_start, c, lane, of,
                               [&](int i) { sum += excess(density[i]); });
    return sum;
  }
  PBF_HD void finish(int c, Part sum) const { cell[c] = sum; }

 private:
  /// What is no number counts as the clip: the guard looks for it elsewhere.
  PBF_HD static int excess(Real rho) {
    const Real c = max2(min2(rho - Real(1), Real(kLevelClip)), Real(-1));
    return int(c * Real(1 << 30));
  }
};

/// The sums around the nodes of level 0 that are on.
template <class Real>
struct LevelNodeSumPass {
  LevelCells grid;
  LevelShape level;
  const Real* answer;
  const std::int64_t* cell;
  std::int64_t* sum;  ///< out

  static constexpr int lanes = 8;
  using Part = std::int64_t;
  PBF_HD Part part(int n, int lane, int of) const {
    Part s = 0;
    if (answer[n] != Real(0))
      for_cells_around(grid, level.place(n), lane, of, [&](int c, int, int, int) { s += cell[c]; });
    return s;
  }
  PBF_HD void finish(int n, Part s) const { sum[n] = s; }
};

/// The same of a coarser level.
template <class Real>
struct LevelCoarserSumPass {
  LevelShape fine, level;
  const Real* answer;
  std::int64_t* sum;  ///< in: fine; out: level

  static constexpr int lanes = 32;
  using Part = std::int64_t;
  PBF_HD Part part(int n, int lane, int of) const {
    Part eight = 0;
    if (answer[level.first + n] != Real(0))
      for_finer_nodes(fine, level, level.place(n), lane, of,
                      [&](int finer, int eighths) { eight += eighths * sum[finer]; });
    return eight;
  }
  PBF_HD void finish(int n, Part eight) const { sum[level.first + n] = eight >> 3; }
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

/// The sums of the levels that are small, then their multipliers.
template <class Real>
struct LevelChain : LevelSteps {
  const Real* answer;
  std::int64_t* sum;
  Real* multiplier;

  PBF_HD LevelCoarserSumPass<Real> coarser(int k) const {
    return {all.level[k - 1], all.level[k], answer, sum};
  }
  PBF_HD LevelMultiplierPass<Real> up(int k) const {
    return {all.level[k], coarser_than(k), k + 1 == all.count, answer, sum, multiplier};
  }

  static constexpr int lanes = LevelCoarserSumPass<Real>::lanes;
  using Part = std::int64_t;
  PBF_HD Part part(int step, int n, int lane, int of) const {
    return coarser(level_of(step)).part(n, lane, of);
  }
  PBF_HD void finish(int step, int n, Part eight) const {
    coarser(level_of(step)).finish(n, eight);
  }
  PBF_HD void operator()(int step, int n) const { up(level_of(step))(n); }
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
  const int* count;  ///< of cells
  Vec4<Real>* move;  ///< out, h

  PBF_HD void operator()(int c) const {
    const GridPlace at = grid.place(c);
    Real sum[3] = {};
    int against = 0;
    for (int n = 0; n < 8; ++n) {
      const int up[3] = {n & 1, n >> 1 & 1, n >> 2};
      if (D == 2 && up[1]) continue;
      const int node = level.at(at[0] + up[0], at[1] + up[1], at[2] + up[2]);
      const Real k = multiplier[node];
      for (int a = 0; a < 3; ++a) sum[a] += up[a] ? k : -k;
      against |= walls[node];
    }
    for (int a = 0; a < 3; ++a) {
      if (D == 2 && a == 1) sum[a] = Real(0);
      sum[a] *= -gamma * Real(1 / ((D == 2 ? 2 : 4) * grid.length(a, at[a])));
      if (!(against >> a & 1) && count[c] > 0)
        sum[a] *= Real(2 * grid.half(at[0], at[1], at[2]) / count[c]);
    }
    move[c] = {sum[0], sum[1], sum[2], Real(0)};
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
