// Levels: sums of C over cells, nodes and coarser nodes, the multipliers of the nodes, and the
// displacement that follows from them. kernels/README.md, "Levels".
#pragma once

#include "kernels/cell_index.h"
#include "kernels/levels.h"

namespace pbf::inline PBF_VARIANT {

/// The mean C of a cell is that of its packing if one particle of many is crowded by others.
inline constexpr double kLevelClip = 0.1;

/// The rows of half cells along x that a cell is summed in, one thread each.
template <int D>
constexpr int kRowsPerCell = D == 2 ? 2 : 4;

/// Sums over the particles in a row of a cell: those that were in it when the lists were made.
template <class Real, int D>
struct LevelCellPass {
  Params<Real> p;
  LevelCells grid;
  const int* bin_start;
  const Vec4<Real>* position;  ///< null where no face is open; else those beyond do not count
  const Real* density;
  LevelSum* row;  ///< out

  PBF_HD void operator()(int n) const {
    const int c = n / kRowsPerCell<D>, part = n % kRowsPerCell<D>;
    const int cx = c % grid.cells[0], yz = c / grid.cells[0];
    const int cy = yz % grid.cells[1], cz = yz / grid.cells[1];
    const int x0 = 4 * cx, x1 = cx + 1 < grid.cells[0] ? x0 + 4 : p.cells_x;
    // The first row of two, or the others: a last cell may have one or three.
    const auto rows = [](int cell, int cells, int of, int second, int& from, int& to) {
      from = 2 * cell + second;
      to = !second ? from + 1 : cell + 1 < cells ? from + 1 : of;
    };
    int y0 = 0, y1 = 1, z0, z1;
    if constexpr (D == 3) rows(cy, grid.cells[1], p.cells_y, part / 2, y0, y1);
    rows(cz, grid.cells[2], p.cells_z, part % 2, z0, z1);
    LevelSum sum;
    for (int z = z0; z < z1; ++z)
      for (int y = y0; y < y1; ++y) {
        const int at = (D == 2 ? z : z * p.cells_y + y) * p.cells_x;
        const int end = bin_start[(at + x1) * bins_per_cell(D)];
        for (int i = bin_start[(at + x0) * bins_per_cell(D)]; i < end; ++i) add(sum, i);
      }
    row[n] = sum;
  }

 private:
  PBF_HD void add(LevelSum& sum, int i) const {
    if (position && !p.boundary.inside(xyz(position[i]))) return;
    const Real c = min2(density[i] - Real(1), Real(kLevelClip));
    if (c >= Real(-1)) sum.excess += std::int64_t(c * Real(1 << 30));
    sum.particles += 1 << 20;
  }
};

/// A node of level 0: the sums of the cells around it. Off (particles = -1) where one of them is
/// not half full or beyond an open face: a hat must not reach into the air.
template <int D>
struct LevelNodePass {
  unsigned walls;
  LevelCells grid;
  LevelShape level;
  const LevelSum* row;
  LevelSum* node;  ///< out

  PBF_HD void operator()(int n) const {
    const int x = n % level.nodes[0], y = n / level.nodes[0] % level.nodes[1];
    const int z = n / level.nodes[0] / level.nodes[1], at[3] = {x, y, z};
    LevelSum sum;
    bool on = true;
    int low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      low[k] = at[k] > 0 ? at[k] - 1 : 0;
      high[k] = at[k] < grid.cells[k] ? at[k] : grid.cells[k] - 1;
      if (level.nodes[k] == 1) continue;  // the axis that a plane has not
      on = on && (at[k] > 0 || walls & (1u << (2 * k)));
      on = on && (at[k] < grid.cells[k] || walls & (2u << (2 * k)));
    }
    for (int c = low[2]; c <= high[2]; ++c)
      for (int b = low[1]; b <= high[1]; ++b)
        for (int a = low[0]; a <= high[0]; ++a) {
          const LevelSum s = of_cell((c * grid.cells[1] + b) * grid.cells[0] + a);
          sum.excess += s.excess;
          sum.particles += s.particles;
          double needed = grid.half_full;
          const int of[3] = {a, b, c};
          for (int k = 0; k < 3; ++k)
            if (of[k] + 1 == grid.cells[k]) needed *= grid.last[k] / grid.edge;
          on = on && double(s.particles) * LevelSum::particle_unit >= needed;
        }
    if (!on) sum.particles = -1 - sum.particles;
    node[n] = sum;
  }

 private:
  PBF_HD LevelSum of_cell(int c) const {
    LevelSum sum;
    for (int r = 0; r < kRowsPerCell<D>; ++r) {
      const LevelSum s = row[c * kRowsPerCell<D> + r];
      sum.excess += s.excess;
      sum.particles += s.particles;
    }
    return sum;
  }
};

/// A node of a coarser level: the finer ones around it, weights 1 and 1/2 along each axis.
struct LevelDownPass {
  LevelShape fine, level;
  LevelSum* node;  ///< in: fine; out: level

  PBF_HD void operator()(int n) const {
    const int at[3] = {n % level.nodes[0], n / level.nodes[0] % level.nodes[1],
                       n / level.nodes[0] / level.nodes[1]};
    LevelSum sum;
    bool on = true;
    for (int c = 0; c < 3; ++c)
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) {
          const Tap x = finer_node(level.from[0], at[0], a, fine.nodes[0]);
          const Tap y = finer_node(level.from[1], at[1], b, fine.nodes[1]);
          const Tap z = finer_node(level.from[2], at[2], c, fine.nodes[2]);
          const int eighths = x.halves * y.halves * z.halves;
          if (eighths == 0) continue;
          LevelSum s = node[fine.at(x.node, y.node, z.node)];
          if (s.particles < 0) {
            on = false;
            s.particles = -1 - s.particles;
          }
          sum.excess += eighths * s.excess;
          sum.particles += eighths * s.particles;
        }
    sum.excess >>= 3;
    sum.particles >>= 3;
    if (!on) sum.particles = -1 - sum.particles;
    node[level.first + n] = sum;
  }
};

/// The multiplier of a node: its own, stiffness times the mean C around it, and what the coarser
/// level says there.
template <class Real>
struct LevelUpPass {
  LevelShape level, coarse;
  bool coarsest;
  Real stiffness;  ///< beta s^2, h^2
  const LevelSum* node;
  Real* multiplier;  ///< in: coarse; out: level, h^2

  PBF_HD void operator()(int n) const {
    const LevelSum s = node[level.first + n];
    Real k(0);
    if (s.particles > 0 && s.excess > 0) {
      const double mean = double(s.excess) * LevelSum::excess_unit /
                          (double(s.particles) * LevelSum::particle_unit);
      k = stiffness * Real(mean);
    }
    if (!coarsest) {
      const int at[3] = {n % level.nodes[0], n / level.nodes[0] % level.nodes[1],
                         n / level.nodes[0] / level.nodes[1]};
      for (int c = 0; c < 2; ++c)
        for (int b = 0; b < 2; ++b)
          for (int a = 0; a < 2; ++a) {
            const Tap x = coarser_node(coarse.from[0], at[0], a);
            const Tap y = coarser_node(coarse.from[1], at[1], b);
            const Tap z = coarser_node(coarse.from[2], at[2], c);
            const int eighths = x.halves * y.halves * z.halves;
            if (eighths == 0) continue;
            k += Real(eighths) * Real(0.125) * multiplier[coarse.at(x.node, y.node, z.node)];
          }
    }
    multiplier[level.first + n] = k;
  }
};

/// The levels from `first` on, which are small: down to the coarsest and up again, one step after
/// the other.
template <class Real>
struct LevelChainPass {
  LevelHierarchy all;
  int first;
  Real stiffness;  ///< of level 0; four times as large on each coarser one
  LevelSum* node;
  Real* multiplier;

  PBF_HD int steps() const { return 2 * (all.count - first); }
  PBF_HD int level_of(int step) const {
    const int down = all.count - first;
    return step < down ? first + step : all.count - 1 - (step - down);
  }
  PBF_HD int size(int step) const { return all.level[level_of(step)].size(); }
  PBF_HD void operator()(int step, int n) const {
    const int k = level_of(step);
    if (step < all.count - first)
      LevelDownPass{all.level[k - 1], all.level[k], node}(n);
    else
      up(k)(n);
  }
  PBF_HD LevelUpPass<Real> up(int k) const {
    const bool coarsest = k + 1 == all.count;
    Real s = stiffness;
    for (int l = 0; l < k; ++l) s *= Real(4);
    return {all.level[k], all.level[coarsest ? k : k + 1], coarsest, s, node, multiplier};
  }
};

/// -gamma grad k at x, k interpolated linearly between the nodes of level 0.
template <class Real>
struct LevelMove {
  static constexpr bool on = true;
  LevelCells grid;
  LevelShape level;
  Vec3<Real> last_inverse;  ///< 1/length of the last cell of each axis
  Real edge_inverse = 0, gamma = 0;
  const Real* multiplier = nullptr;

  PBF_HD Vec3<Real> operator()(Vec3<Real> x) const {
    Real t[3], inverse[3];
    int at[3], step[3];
    const Real place[3] = {x.x, x.y, x.z};
    const Real last[3] = {last_inverse.x, last_inverse.y, last_inverse.z};
    for (int k = 0; k < 3; ++k) {
      const Real cell = place[k] * edge_inverse;
      const int end = grid.cells[k] - 1;
      at[k] = cell > Real(0) ? (cell < Real(end) ? int(cell) : end) : 0;
      inverse[k] = at[k] == end ? last[k] : edge_inverse;
      t[k] = (place[k] - Real(at[k]) * Real(grid.edge)) * inverse[k];
      t[k] = max2(Real(0), min2(Real(1), t[k]));
      step[k] = level.nodes[k] > 1;
    }
    Real q[2][2][2];
    for (int c = 0; c < 2; ++c)
      for (int b = 0; b < 2; ++b)
        for (int a = 0; a < 2; ++a)
          q[c][b][a] =
              multiplier[level.at(at[0] + a * step[0], at[1] + b * step[1], at[2] + c * step[2])];
    const auto mix = [](Real u, Real w, Real s) { return u + s * (w - u); };
    const auto slope = [&](Real d00, Real d01, Real d10, Real d11, int u, int w) {
      return mix(mix(d00, d01, t[u]), mix(d10, d11, t[u]), t[w]);
    };
    return {-gamma * inverse[0] *
                slope(q[0][0][1] - q[0][0][0], q[0][1][1] - q[0][1][0], q[1][0][1] - q[1][0][0],
                      q[1][1][1] - q[1][1][0], 1, 2),
            -gamma * inverse[1] *
                slope(q[0][1][0] - q[0][0][0], q[0][1][1] - q[0][0][1], q[1][1][0] - q[1][0][0],
                      q[1][1][1] - q[1][0][1], 0, 2),
            -gamma * inverse[2] *
                slope(q[1][0][0] - q[0][0][0], q[1][0][1] - q[0][0][1], q[1][1][0] - q[0][1][0],
                      q[1][1][1] - q[0][1][1], 0, 1)};
  }
};
/// No levels: nothing to move, nothing to carry.
template <class Real>
struct NoLevelMove {
  static constexpr bool on = false;
};

}  // namespace pbf::inline PBF_VARIANT
