// Levels: what is made with the lists and lasts as long as they do. Who is in which cell, which
// nodes are on and how strongly they answer, where walls hold the fluid. kernels/README.md,
// "Levels".
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

/// The cell of each particle, and how many there are in it.
template <class Real, int D>
struct LevelHomePass : LevelBrickPass<D> {
  using LevelBrickPass<D>::grid;
  Params<Real> p;
  const int* bin_start;
  const Vec4<Real>* position;  ///< null where no face is open; those beyond are in no cell
  int* home;                   ///< out; -1: in no cell
  int* count;                  ///< out, of each cell
  std::int64_t* full;          ///< out: the same in kCountUnit, -1 where it is not half full

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
  PBF_HD std::int64_t finish(int c, Part inside) const {
    count[c] = inside;
    return full[c] = inside < grid.half(grid.place(c)) ? -1 : std::int64_t(inside) << 20;
  }
  PBF_HD void finish_corner(int brick, int which, const LevelPart& sum) const {
    this->at(brick, which) = sum.bits < 0 ? -1 : sum.number;
  }
};

/// What a node makes of the sum of C around it while the lists last: multiplier = answer * sum. Off
/// (0) where a cell under its hat is not half full, or an open face: no hat may reach into the air.
template <class Real>
struct LevelNodePass : LevelSums {
  unsigned closed;   ///< Box::walls
  double stiffness;  ///< of level 0; four times as large on each coarser one
  Real* answer;      ///< out
  int* walls;        ///< out: WallBits of those under its hat; none where it is off

  using Part = LevelPart;
  PBF_HD Part part(int item, int lane, int of) const {
    Part sum{};
    for_terms(node(item), lane, of, [&](std::int64_t value, int weight) {
      sum.number += term(value, weight);
      sum.bits |= value;
      return sum.bits < 0;  // off, whatever else is there
    });
    return sum;
  }
  PBF_HD void finish(int item, const Part& sum) const {
    const int n = node(item), l = all.of(n);
    const GridPlace at = all.level[l].place(n - all.level[l].first);
    bool on = sum.bits >= 0;
    int against = 0;
    for (int k = 0; k < 3; ++k) {
      const unsigned ends = all.ends(l, k, at[k]);
      on = on && !(ends & ~(closed >> 2 * k));
      against |= int(ends) << 2 * k;
    }
    double s = stiffness;
    for (int coarser = 0; coarser < l; ++coarser) s *= 4;
    answer[n] = on ? Real(s * kExcessUnit / (double(sum.number) * kCountUnit)) : Real(0);
    walls[n] = on ? against : 0;
  }
};

/// WallBits of the nodes of level `from` in the box, of the next coarser ones whose hats overlap
/// with theirs, and so on before level `to`, for which the box is widened: the share of a thread.
PBF_HD int walls_around(const LevelHierarchy& all, const int* walls, int from, int to,
                        GridPlace& low, GridPlace& end, int lane, int of) {
  int found = 0;
  for (int l = from; l < to; ++l) {
    const LevelShape& level = all.level[l];
    unsigned any = 0;
    for (int k = 0; k < 3; ++k) any |= all.ends(l, k, low[k]) | all.ends(l, k, end[k] - 1);
    if (any)
      for_box(low, end, lane, of, [&](int x, int y, int z) {
        found |= walls[level.at(x, y, z)];
        return false;
      });
    if (l + 1 < all.count)
      for (int k = 0; k < 3; ++k) {
        const int last = all.level[l + 1].nodes[k];
        low.k[k] = last == 1 ? 0 : (low[k] - 1) / 2;
        end.k[k] = min2((end[k] - 1) / 2 + 2, last);
      }
  }
  return found;
}

/// Of level 2 and coarser nodes the walls that they and those around them know: a cell asks them.
struct LevelReachPass {
  static constexpr int level = 2;
  LevelHierarchy all;
  const int* walls;  ///< of each node
  int* reach;        ///< out

  PBF_HD int items() const { return all.count > level ? all.level[level].size() : 0; }

  static constexpr int lanes = 32;
  using Part = LevelPart;
  PBF_HD Part part(int n, int lane, int of) const {
    GridPlace low = all.level[level].place(n), end{{low[0] + 1, low[1] + 1, low[2] + 1}};
    return {0, walls_around(all, walls, level, all.count, low, end, lane, of)};
  }
  PBF_HD void finish(int n, const Part& found) const {
    reach[all.level[level].first + n] = int(found.bits);
  }
};

/// What a cell makes of the slope of the multipliers in its middle, per cell: the displacement is
/// -gamma times their gradient. Along an axis without a wall that could take it, the fluid must not
/// get momentum: there cells with fewer particles move them farther, so that what a hat does adds
/// up to 0. The walls are those of the cell's corners, of the next coarser nodes whose hats overlap
/// with the corners', and so on.
template <class Real>
struct LevelFactorPass {
  LevelHierarchy all;
  LevelCells grid;
  double gamma;
  const int* count;    ///< of each cell
  const int* walls;    ///< of each node
  const int* reach;    ///< LevelReachPass
  Vec4<Real>* factor;  ///< out, 1/h; 0 where nobody is; w: those walls, as WallBits

  static constexpr int lanes = 4;
  using Part = LevelPart;
  PBF_HD Part part(int c, int lane, int of) const {
    Part found{};
    if (count[c] == 0) return found;
    GridPlace low = grid.place(c), end = low;
    for (int k = 0; k < 3; ++k) end.k[k] += all.level[0].nodes[k] == 1 ? 1 : 2;
    found.bits =
        walls_around(all, walls, 0, min2(all.count, LevelReachPass::level), low, end, lane, of);
    if (all.count > LevelReachPass::level)
      for_box(low, end, lane, of, [&](int x, int y, int z) {
        found.bits |= reach[all.level[LevelReachPass::level].at(x, y, z)];
        return false;
      });
    return found;
  }
  PBF_HD void finish(int c, const Part& found) const {
    const GridPlace at = grid.place(c);
    const double at_rest = count[c] > 0 ? 2 * grid.half(at) / count[c] : 0;
    Real along[3] = {};
    for (int k = 0; k < 3 && count[c] > 0; ++k) {
      const double share = found.bits >> 2 * k & 3 ? 1 : at_rest;
      along[k] = Real(-gamma / grid.length(k, at[k]) * share);
    }
    factor[c] = {along[0], along[1], along[2], Real(int(found.bits))};
  }
};

}  // namespace pbf::inline PBF_VARIANT
