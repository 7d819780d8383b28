// Loads on walls from the levels. kernels/README.md, "Loads".
#pragma once

#include "kernels/boundary/loads.h"
#include "kernels/pass_levels.h"

namespace pbf::PBF_VARIANT {

/// Over the nodes of level 0. The multiplier of a node, summed over all levels, pushes the cells on
/// its two sides apart. On a wall there is only one side, and this push is the pressure on the
/// wall. Inside, a difference remains if the cells hold different numbers of particles. It is
/// booked on the wall that holds the fluid along this axis, on the nearer one if there are two.
template <class Real>
struct LevelLoadPass {
  LevelHierarchy all;
  LevelCells grid;
  const Real* multiplier;
  const Vec4<Real>* factor;  ///< of cells, LevelFactorPass
  const int* count;          ///< of cells
  Vec3<Real> extent;         ///< h
  LoadBook<Real> loads;      ///< sums is not null

  PBF_HD void operator()(int n) const {
    const LevelShape& nodes = all.level[0];
    const GridPlace at = nodes.place(n);
    Real k(0);
    for (int l = 0; l < all.count; ++l) k += multiplier_at(l, at);
    if (k == Real(0)) return;
    GridPlace low, end;  // the cells around it
    for (int a = 0; a < 3; ++a) {
      low.k[a] = max2(at[a] - 1, 0);
      end.k[a] = min2(at[a] + 1, grid.cells[a]);
    }
    for (int a = 0; a < 3; ++a)
      if (nodes.nodes[a] > 1) push(n, at, low, end, a, double(k));
  }

 private:
  PBF_HD void push(int n, GridPlace at, GridPlace low, GridPlace end, int axis, double k) const {
    double way = 0;  // sum over all particles around the node
    unsigned against = 0;
    for_box(low, end, 0, 1, [&](int x, int y, int z) {
      const int c = (z * grid.cells[1] + y) * grid.cells[0] + x;
      const Real along[3] = {factor[c].x, factor[c].y, factor[c].z};
      const bool below = (axis == 0 ? x : axis == 1 ? y : z) < at[axis];
      way += (below ? k : -k) * count[c] * double(along[axis]);
      against |= unsigned(factor[c].w) >> 2 * axis & 3;
      return false;
    });
    if (against == 0) return;  // the pushes add up to 0
    for (int a = 0; a < 3; ++a)
      if (a != axis && all.level[0].nodes[a] > 1) way /= 2;
    const int last = all.level[0].nodes[axis] - 1;
    const bool high = against == 3 ? 2 * at[axis] > last : against == 2;
    const Real edge = Real(grid.edge);
    const Vec3<Real> x{min2(Real(at[0]) * edge, extent.x), min2(Real(at[1]) * edge, extent.y),
                       min2(Real(at[2]) * edge, extent.z)};
    const Real w = Real(way), none(0);
    loads.add(2 * axis + high, n, x,
              {axis == 0 ? w : none, axis == 1 ? w : none, axis == 2 ? w : none});
  }
  /// The multiplier of level l at node `at` of level 0, interpolated linearly.
  PBF_HD Real multiplier_at(int l, GridPlace at) const {
    const LevelShape& level = all.level[l];
    Real sum(0);
    for (int m = 0; m < 8; ++m) {
      Real weight(1);
      int node[3];
      for (int a = 0; a < 3; ++a) {
        const bool one = level.nodes[a] == 1, up = m >> a & 1;
        const int below = one ? 0 : at[a] >> l;
        const Real share = one ? Real(0) : Real(at[a] - (below << l)) / Real(1 << l);
        node[a] = below + up;
        weight *= up ? share : Real(1) - share;
      }
      if (weight != Real(0)) sum += weight * multiplier[level.at(node[0], node[1], node[2])];
    }
    return sum;
  }
};

}  // namespace pbf::PBF_VARIANT
