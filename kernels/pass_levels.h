// Levels, in an iteration: sums of C over cells and nodes, the multipliers of the nodes, and the
// displacement that follows from them. kernels/README.md, "Levels".
#pragma once

#include "kernels/pass_level_cells.h"

namespace pbf::inline PBF_VARIANT {

/// C counts up to here in the mean of a cell: else a few particles in one place would push all
/// those around them.
inline constexpr double kLevelClip = 0.05;

/// Sums of C, signed and clipped, over the cells.
template <class Real, int D>
struct LevelSumPass {
  Params<Real> p;
  LevelCells grid;
  const int* bin_start;
  const int* home;  ///< null where no face is open
  const Real* density;
  std::int64_t* cell;  ///< out, in kExcessUnit

  static constexpr int lanes = 4;
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

/// A multiplier that only pushes.
template <class Real>
PBF_HD Real level_multiplier(Real answer, std::int64_t sum) {
  return sum > 0 ? answer * Real(sum) : Real(0);
}

/// The sums around the nodes of level 0 that are on.
template <class Real>
struct LevelNodeSumPass {
  LevelCells grid;
  LevelShape level;
  const Real* answer;
  const std::int64_t* cell;
  std::int64_t* sum;  ///< out

  PBF_HD void operator()(int n) const {
    std::int64_t s = 0;
    if (answer[n] != Real(0))
      for_cells_around(grid, level.place(n), 0, 1, [&](int c, int, int, int) { s += cell[c]; });
    sum[n] = s;
  }
};

/// The same of a coarser level, and the multipliers that follow from it alone.
template <class Real>
struct LevelCoarserSumPass {
  LevelShape fine, level;
  const Real* answer;
  std::int64_t* sum;  ///< in: fine; out: level
  Real* multiplier;   ///< out, h^2

  static constexpr int lanes = 8;
  using Part = std::int64_t;
  PBF_HD Part part(int n, int lane, int of) const {
    Part eight = 0;
    if (answer[level.first + n] != Real(0))
      for_finer_nodes(fine, level, level.place(n), lane, of,
                      [&](int finer, int eighths) { eight += eighths * sum[finer]; });
    return eight;
  }
  PBF_HD void finish(int n, Part eight) const {
    const int at = level.first + n;
    const std::int64_t s = eight >> 3;
    sum[at] = s;
    multiplier[at] = level_multiplier(answer[at], s);
  }
};

/// Levels that are small, one after the other.
template <class Real>
struct LevelSumChain : LevelSteps {
  const Real* answer;
  std::int64_t* sum;
  Real* multiplier;

  PBF_HD LevelCoarserSumPass<Real> coarser(int k) const {
    return {all.level[k - 1], all.level[k], answer, sum, multiplier};
  }

  PBF_HD int steps() const { return down(); }
  static constexpr int lanes = 32;
  using Part = std::int64_t;
  PBF_HD Part part(int step, int n, int lane, int of) const {
    return coarser(level_of(step)).part(n, lane, of);
  }
  PBF_HD void finish(int step, int n, Part eight) const {
    coarser(level_of(step)).finish(n, eight);
  }
  PBF_HD void operator()(int, int) const {}
};

/// The multiplier of a node of level 0: its own, and what every coarser level says there.
template <class Real>
struct LevelMultiplierPass {
  LevelHierarchy all;
  const Real* answer;
  const std::int64_t* sum;
  Real* multiplier;  ///< in: of the coarser levels; out: of level 0, h^2

  PBF_HD void operator()(int n) const {
    Real k = level_multiplier(answer[n], sum[n]);
    if (answer[n] != Real(0))  // off: beyond the hats of all levels
      for (int l = 1; l < all.count; ++l) k += interpolated(l, all.level[0].place(n));
    multiplier[n] = k;
  }

 private:
  /// Linearly between the nodes of level l, where the node `at` of level 0 is.
  PBF_HD Real interpolated(int l, GridPlace at) const {
    const LevelShape& level = all.level[l];
    int low[3];
    Real share[3];  // of the node behind
    for (int k = 0; k < 3; ++k) {
      const bool one = level.nodes[k] == 1;
      low[k] = one ? 0 : at[k] >> l;
      share[k] = one ? Real(0) : Real(at[k] - (low[k] << l)) / Real(1 << l);
    }
    Real k(0);
    for (int m = 0; m < 8; ++m) {
      Real weight(1);
      for (int a = 0; a < 3; ++a) weight *= m >> a & 1 ? share[a] : Real(1) - share[a];
      if (weight != Real(0))
        k += weight *
             multiplier[level.at(low[0] + (m & 1), low[1] + (m >> 1 & 1), low[2] + (m >> 2))];
    }
    return k;
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
