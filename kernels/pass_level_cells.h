// Levels: quantities that are computed with the neighbor lists and stay valid as long as these: the
// cell of each particle, the nodes that are on and their response, and where walls hold the fluid.
// kernels/README.md, "Levels".
//
// Several threads may share an item of a pass with a type Part: each adds some of the terms. These
// are integers or bits, so it does not matter which thread adds which.
#pragma once

#include "kernels/boundary/solid_scene.h"
#include "kernels/cell_index.h"
#include "kernels/levels.h"

namespace pbf::PBF_VARIANT {

/// The share of thread `lane` of `of` threads in the particles of a cell: calls f(y, z, run, first,
/// step) for some of its runs, of which the thread takes particles first, first + step, ... from
/// the start on; y, z: their row of the search grid. A run is short, and a thread waits for where
/// it begins, so most threads take different ones.
template <int D, class F>
PBF_HD void for_runs(const LevelCells& grid, GridPlace cell, int lane, int of, F&& f) {
  constexpr int usual = D == 2 ? 2 : 4;
  const auto rows = [&](int axis) { return cell[axis] + 1 < grid.cells[axis] ? 2 : 3; };
  const int along_y = D == 2 ? 1 : rows(1), runs = along_y * rows(2);
  const int step = of > usual ? of / usual : 1;
  for (int n = lane / step; n < runs; n += of / step) {
    const int y = D == 2 ? 0 : 2 * cell[1] + n % along_y, z = 2 * cell[2] + n / along_y;
    const int run = (D == 2 ? z : z * grid.rows(1) + y) * (grid.cells[0] + 1) + cell[0];
    f(y, z, run, lane % step, step);
  }
}

/// The cell of each particle, and the number of particles in each cell.
template <class Real, int D>
struct LevelHomePass : LevelBrickPass<D> {
  using LevelBrickPass<D>::grid;
  Params<Real> p;
  const int* bin_start;
  const Vec4<Real>* position;  ///< null if no face is open; particles beyond are in no cell
  const SolidScene<Real>* solid_scene;  ///< with the obstacles; null: there are none
  int* run_start;                       ///< out, LevelCells::runs
  int* home;                            ///< out; -1: in no cell
  int* count;                           ///< out, of each cell
  /// Out: the count in kCountUnit; -1 if less than half full, or if an obstacle may reach into it.
  std::int64_t* full;

  static constexpr int lanes = 8;
  using Part = int;
  PBF_HD Part part(GridPlace cell, int lane, int of) const {
    int inside = 0;
    const int c = grid.at(cell);
    const bool last = cell[0] + 1 == grid.cells[0];
    for_runs<D>(grid, cell, lane, of, [&](int y, int z, int run, int first, int step) {
      int begin = 0, end = 0;
      if (y < p.cells_y && z < p.cells_z) {
        const int row = (z * p.cells_y + y) * p.cells_x;
        begin = bin_start[(row + 4 * cell[0]) * bins_per_cell(D)];
        end = bin_start[(row + (last ? p.cells_x : 4 * cell[0] + 4)) * bins_per_cell(D)];
      }
      if (first == 0) run_start[run] = begin;
      if (first == 0 && last) run_start[run + 1] = end;
      for (int i = begin + first; i < end; i += step) {
        const bool in = !position || p.boundary.inside(xyz(position[i]));
        home[i] = in ? c : -1;
        inside += in;
      }
    });
    return inside;
  }
  PBF_HD std::int64_t finish(GridPlace cell, Part inside) const {
    const int c = grid.at(cell);
    count[c] = inside;
    const bool off = inside < grid.half(cell) || (solid_scene && obstacle_reaches(cell));
    return full[c] = off ? -1 : std::int64_t(inside) << 20;
  }
  PBF_HD void finish_corner(GridPlace brick, int which, const LevelPart& sum) const {
    this->at(brick, which) = sum.bits < 0 ? -1 : sum.number;
  }

 private:
  /// Whether an obstacle reaches into the sphere around the cell.
  PBF_HD bool obstacle_reaches(GridPlace cell) const {
    Real middle[3] = {}, squares = 0;
    for (int k = 0; k < 3; ++k) {
      if (D == 2 && k == 1) continue;
      const Real half = Real(grid.length(k, cell[k]) / 2);
      middle[k] = Real(cell[k] * grid.edge) + half;
      squares += half * half;
    }
    const Real radius = square_root(squares);
    for (int k = 0; k < solid_scene->solids; ++k)
      if (distance<D>(solid_scene->solid[k].solid, {middle[0], middle[1], middle[2]}) < radius)
        return true;
    return false;
  }
};

/// The response of each node, valid as long as the lists: multiplier = answer * sum of C around it.
/// 0 (off) if a cell under its hat is less than half full or the hat reaches an open face.
template <class Real>
struct LevelNodePass : LevelSums {
  unsigned closed;   ///< Box::walls
  double stiffness;  ///< of level 0; four times as large on each coarser one
  Real* answer;      ///< out
  int* walls;        ///< out: WallBits of the walls under its hat; 0 if it is off

  using Part = LevelPart;
  PBF_HD Part part(int item, int lane, int of) const {
    Part sum{};
    for_terms(node(item), lane, of, [&](std::int64_t value, int weight) {
      sum.number += term(value, weight);
      sum.bits |= value;
      return sum.bits < 0;  // off; further terms cannot change that
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
    Real a(0);
    if (on) {
      double s = stiffness;
      for (int coarser = 0; coarser < l; ++coarser) s *= 4;
      a = Real(s * kExcessUnit / (double(sum.number) * kCountUnit));
    }
    answer[n] = a;
    walls[n] = on ? against : 0;
  }
};

/// The share of a thread in the WallBits of the nodes of level `from` in a box, of the next coarser
/// nodes whose hats overlap with these, and so on below level `to`. Widens the box for level `to`.
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

/// For each node of level 2: the walls of this node, of the adjacent nodes, and of the coarser
/// nodes whose hats overlap with these.
struct LevelReachPass {
  static constexpr int level = 2;
  LevelHierarchy all;
  const int* walls;  ///< of each node
  int* reach;        ///< out

  PBF_HD int items() const { return all.count > level ? all.level[level].size() : 0; }

  static constexpr int lanes = 32;
  using Part = LevelPart;
  PBF_HD Part part(int n, int lane, int of) const {
    GridPlace low = all.level[level].place(n), end = low;
    for (int k = 0; k < 3; ++k) {
      low.k[k] = max2(low[k] - 1, 0);
      end.k[k] = min2(end[k] + 2, all.level[level].nodes[k]);
    }
    return {0, walls_around(all, walls, level, all.count, low, end, lane, of)};
  }
  PBF_HD void finish(int n, const Part& found) const { reach[n] = int(found.bits); }
};

/// Factors from the slope of the multipliers in the middle of a cell, per cell length, to the
/// displacement -gamma times their gradient. Along an axis without a wall that holds the fluid,
/// levels must not add momentum: there the factor contains the number of particles at rest over the
/// actual number, so that the effects of a hat add up to 0. The walls are those of the cell's
/// corners, of the next coarser nodes whose hats overlap with these, and so on.
template <class Real>
struct LevelFactorPass {
  LevelHierarchy all;
  LevelCells grid;
  double by_edge, by_last[3];  ///< gamma over the lengths of cells
  const int* count;            ///< of each cell
  const int* walls;            ///< of each node
  const int* reach;            ///< LevelReachPass
  Vec4<Real>* factor;          ///< out, 1/h; 0 in empty cells; w: these walls, as WallBits

  PBF_HD void operator()(int c) const {
    const GridPlace at = grid.place(c);
    const int particles = count[c];
    const unsigned found = particles > 0 ? walls_of(at) : 0;
    const double at_rest = particles > 0 ? 2 * grid.half(at) / particles : 0;
    Real along[3] = {};
    for (int k = 0; k < 3 && particles > 0; ++k) {
      const double share = found >> 2 * k & 3 ? 1 : at_rest;
      along[k] = Real(-(at[k] + 1 == grid.cells[k] ? by_last[k] : by_edge) * share);
    }
    factor[c] = {along[0], along[1], along[2], Real(int(found))};
  }

 private:
  /// On level 2, the nodes to consider surround one or two nodes along each axis (`reach`).
  PBF_HD unsigned walls_of(GridPlace at) const {
    constexpr int coarse = LevelReachPass::level;
    GridPlace low = at, end = at, last = at;
    for (int k = 0; k < 3; ++k) end.k[k] += all.level[0].nodes[k] == 1 ? 1 : 2;
    int found = walls_around(all, walls, 0, min2(all.count, coarse), low, end, 0, 1);
    if (all.count <= coarse) return unsigned(found);
    const LevelShape& level = all.level[coarse];
    for (int k = 0; k < 3; ++k) {
      low.k[k] = min2((at[k] + 1) / 4, level.nodes[k] - 1);
      last.k[k] = min2((at[k] + 3) / 4, level.nodes[k] - 1);
    }
    for (int m = 0; m < 8; ++m)
      found |= reach[level.at(m & 1 ? last[0] : low[0], m & 2 ? last[1] : low[1],
                              m & 4 ? last[2] : low[2]) -
                     level.first];
    return unsigned(found);
  }
};

}  // namespace pbf::PBF_VARIANT
