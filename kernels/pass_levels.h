// Levels, in an iteration: sums of C over cells and nodes, the multipliers of the nodes, and the
// displacement that follows from them. kernels/README.md, "Levels".
#pragma once

#include "kernels/pass_chain.h"
#include "kernels/pass_level_cells.h"

namespace pbf::PBF_VARIANT {

/// Upper limit of C in the mean of a cell. Without it, a few particles in one place would push
/// their whole neighborhood.
inline constexpr double kLevelClip = 0.05;

/// Sums of C, signed and clipped, over the cells.
template <class Real, int D>
struct LevelSumPass : LevelBrickPass<D> {
  using LevelBrickPass<D>::grid;
  const int* run_start;  ///< LevelHomePass
  const int* home;       ///< null where no face is open
  const Real* density;
  std::int64_t* sum;  ///< out, of each cell in kExcessUnit

  static constexpr Chain chain = Chain::first;
  static constexpr int lanes = 2, at_once = 16;  ///< loads that are issued together
  using Part = std::int64_t;
  PBF_HD Part part(GridPlace cell, int lane, int of) const {
    Part mine = 0;
    for_runs<D>(grid, cell, lane, of, [&](int, int, int run, int first, int step) {
      const int end = run_start[run + 1];
      for (int i = run_start[run] + first; i < end; i += at_once * step) {
        Real rho[at_once];
        for (int k = 0; k < at_once; ++k) {
          const int j = i + k * step;
          rho[k] = j < end && (!home || home[j] >= 0) ? density[j] : Real(1);
        }
        for (int k = 0; k < at_once; ++k) mine += excess(rho[k]);
      }
    });
    return mine;
  }
  PBF_HD std::int64_t finish(GridPlace cell, Part here) const { return sum[grid.at(cell)] = here; }
  PBF_HD Part share(int which, int k, Part value) const {
    return LevelBrickPass<D>::share(which, k, value).number;
  }
  PBF_HD void finish_corner(GridPlace brick, int which, Part here) const {
    this->at(brick, which) = here;
  }

 private:
  /// NaN counts as the clip; the guard detects it elsewhere.
  PBF_HD static int excess(Real rho) {
    const Real c = max2(min2(rho - Real(1), Real(kLevelClip)), Real(-1));
    return int(c * Real(1 << 30));
  }
};

/// The sums around the nodes that are on, and the multipliers, which are never negative.
template <class Real>
struct LevelMultiplierPass : LevelSums {
  const Real* answer;
  Real* multiplier;  ///< out, h^2

  static constexpr Chain chain = Chain::inner;
  using Part = std::int64_t;
  /// Its multiplier is 0, whatever the sums are.
  PBF_HD bool is_off(int item) const { return answer[node(item)] == Real(0); }
  PBF_HD Part part(int item, int lane, int of) const {
    Part sum_here = 0;
    if (!is_off(item))
      for_terms(node(item), lane, of, [&](std::int64_t value, int weight) {
        sum_here += term(value, weight);
        return false;
      });
    return sum_here;
  }
  PBF_HD void finish(int item, Part sum_here) const {
    const int n = node(item);
    multiplier[n] = sum_here > 0 ? answer[n] * Real(sum_here) : Real(0);
  }
};

/// The common displacement of the particles of a cell, from the slope of the multipliers in its
/// middle: the sum over all levels, each interpolated linearly between its nodes.
template <class Real>
struct LevelMovePass {
  LevelHierarchy all;
  LevelCells grid;
  const Real* multiplier;
  const Vec4<Real>* factor;
  Vec4<Real>* move;  ///< out, h

  static constexpr Chain chain = Chain::inner;
  PBF_HD void operator()(int c) const {
    const Vec4<Real> f = factor[c];
    Vec3<Real> slope{};
    for (int l = 0; l < all.count && f.x != Real(0); ++l)
      slope = slope + slope_of(l, grid.place(c));
    move[c] = {f.x * slope.x, f.y * slope.y, f.z * slope.z, Real(0)};
  }

 private:
  PBF_HD static Real between(Real a, Real b, Real share) { return a + share * (b - a); }
  /// The slope of level l, per cell length.
  PBF_HD Vec3<Real> slope_of(int l, GridPlace at) const {
    const LevelShape& level = all.level[l];
    const Real cell = Real(1) / Real(1 << l);
    const GridPlace low{{at[0] >> l, at[1] >> l, at[2] >> l}};
    Real share[3];  // weights of the upper nodes; a single node is its own upper one
    for (int k = 0; k < 3; ++k) share[k] = (Real(at[k] - (low[k] << l)) + Real(0.5)) * cell;
    const int x = level.nodes[0] > 1 ? 1 : 0, y = level.nodes[1] > 1 ? level.nodes[0] : 0;
    const Real* k = multiplier + level.at(low[0], low[1], low[2]);
    Real value[2], along_x[2], along_y[2];
    for (int z = 0; z < 2; ++z) {
      const Real a = k[0], b = k[x], c = k[y], d = k[y + x];
      along_x[z] = between(b - a, d - c, share[1]);
      along_y[z] = between(c - a, d - b, share[0]);
      value[z] = between(between(a, b, share[0]), between(c, d, share[0]), share[1]);
      if (level.nodes[2] > 1) k += level.nodes[0] * level.nodes[1];
    }
    return cell * Vec3<Real>{between(along_x[0], along_x[1], share[2]),
                             between(along_y[0], along_y[1], share[2]), value[1] - value[0]};
  }
};

/// The displacement of a particle by the levels.
template <class Real>
struct LevelMove {
  static constexpr bool on = true;
  OwnRows<const int> home;
  const Vec4<Real>* move;

  PBF_HD Vec3<Real> operator()(int i) const {
    return home[i] >= 0 ? xyz(move[home[i]]) : Vec3<Real>{};
  }
};
/// Without levels.
template <class Real>
struct NoLevelMove {
  static constexpr bool on = false;
};

}  // namespace pbf::PBF_VARIANT
