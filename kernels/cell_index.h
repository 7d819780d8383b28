// Cells of the uniform grid, in linear order with x fastest. D: dimensions of the scene; in two
// dimensions there is one layer of cells along y.
#pragma once

#include "kernels/params.h"

namespace pbf::PBF_VARIANT {

/// Cell coordinate of x along one axis; 0 for NaN. Beyond its ends the grid is mirrored repeatedly.
/// The search stays exact for particles outside, because mirrored cells of neighbors are equal or
/// adjacent. It also spreads these particles over the grid; in the outermost cells, those that left
/// through an open face would form pairs with all others.
template <class Real>
PBF_HD int cell_coordinate(Real x, Real inv_cell, int cells) {
  constexpr int kFarthest = 1 << 30;
  Real s = x * inv_cell;
  if (!(s >= Real(0))) s = -s;  // mirrored at 0
  int c = s < Real(kFarthest) ? int(s) : s >= Real(kFarthest) ? kFarthest - 1 : 0;
  if (c < cells) return c;
  c %= 2 * cells;
  return c < cells ? c : 2 * cells - 1 - c;
}

/// x counts half cells, so the runs of candidates below are 2.5 cells long instead of 3. Int: int,
/// or several of them (kernels/lanes.h).
template <class Int>
struct GridCellOf {
  Int x, y, z;
};
using GridCell = GridCellOf<int>;

template <int D, class V, class Real>
PBF_HD auto cell_of(Vec3<V> x, const Params<Real>& p) {
  using Int = decltype(cell_coordinate(x.x, p.inv_cell, p.cells_x));
  return GridCellOf<Int>{cell_coordinate(x.x + p.below.x, p.inv_cell + p.inv_cell, p.cells_x),
                         D == 2 ? Int(0) : cell_coordinate(x.y + p.below.y, p.inv_cell, p.cells_y),
                         cell_coordinate(x.z + p.below.z, p.inv_cell, p.cells_z)};
}

/// Bins of a half cell: the quarters of its y-z face, in two dimensions the halves of its z edge.
/// Particles are sorted by bin, so particles adjacent in memory are about half a cell apart and
/// share most of their neighbors.
constexpr int bins_per_cell(int dimensions) { return dimensions == 2 ? 2 : 4; }

template <int D, class V, class Real>
PBF_HD auto bin_of(Vec3<V> x, const Params<Real>& p) {
  const auto c = cell_of<D>(x, p);
  const Real twice = p.inv_cell + p.inv_cell;
  const auto z = cell_coordinate(x.z + p.below.z, twice, 2 * p.cells_z) & 1;
  if constexpr (D == 2) {
    return (c.z * p.cells_x + c.x) * bins_per_cell(D) + z;
  } else {
    const auto y = cell_coordinate(x.y + p.below.y, twice, 2 * p.cells_y) & 1;
    return ((c.z * p.cells_y + c.y) * p.cells_x + c.x) * bins_per_cell(D) + 2 * z + y;
  }
}

template <class Real>
PBF_HD int bin_count(const Params<Real>& p) {
  return p.cells_x * p.cells_y * p.cells_z * bins_per_cell(p.dimensions);
}

/// Bins begin ... end - 1.
struct BinRange {
  int begin = 0, end = 0;
  PBF_HD bool has(int bin) const { return unsigned(bin - begin) < unsigned(end - begin); }
  bool operator==(const BinRange&) const = default;
};

/// Calls f(begin, end) for up to nine runs of particles (three in two dimensions) that contain
/// every particle within one cell edge of a particle in the cells (x_low..x_high, y, z). A run is a
/// row of half cells from x_low - 2 to x_high + 2. Order: z, y, x. `bin_start`: first particle of
/// each bin; its last entry is the particle count.
template <int D, class Real, class F>
PBF_HD void for_each_run(int x_low, int x_high, int y, int z, const int* bin_start,
                         const Params<Real>& p, F&& f) {
  const int x0 = x_low > 2 ? x_low - 2 : 0;
  const int x1 = x_high + 2 < p.cells_x ? x_high + 2 : p.cells_x - 1;
  const int y0 = D == 3 && y > 0 ? y - 1 : 0;
  const int y1 = D == 2 ? 0 : y + 1 < p.cells_y ? y + 1 : p.cells_y - 1;
  const int z0 = z > 0 ? z - 1 : 0, z1 = z + 1 < p.cells_z ? z + 1 : p.cells_z - 1;
  for (int k = z0; k <= z1; ++k)
    for (int j = y0; j <= y1; ++j) {
      const int row = (D == 2 ? k : k * p.cells_y + j) * p.cells_x;
      f(bin_start[(row + x0) * bins_per_cell(D)], bin_start[(row + x1 + 1) * bins_per_cell(D)]);
    }
}

/// The runs for a particle at x.
template <int D, class Real, class F>
PBF_HD void for_each_run(Vec3<Real> x, const int* bin_start, const Params<Real>& p, F&& f) {
  const GridCell c = cell_of<D>(x, p);
  for_each_run<D>(c.x, c.x, c.y, c.z, bin_start, p, f);
}

}  // namespace pbf::PBF_VARIANT
