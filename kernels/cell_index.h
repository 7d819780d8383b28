// Cells of the uniform grid, linear order with x fastest.
#pragma once

#include "kernels/params.h"

namespace pbf {

/// Cell coordinate of x along one axis, clamped to the grid; NaN goes to 0. The clamp keeps the
/// search exact for particles outside the grid: the map is monotone, so two particles closer than
/// the edge of a cell still lie in the same or in adjacent cells.
template <class Real>
PBF_HD int cell_coordinate(Real x, Real inv_cell, int cells) {
  Real s = x * inv_cell;
  if (!(s > Real(0))) return 0;
  if (s >= Real(cells)) return cells - 1;
  int c = int(s);
  return c < cells ? c : cells - 1;
}

struct Cell {
  int x, y, z;
};

template <class Real>
PBF_HD Cell cell_of(Vec3<Real> x, const Params<Real>& p) {
  return {cell_coordinate(x.x, p.inv_cell, p.cells_x), cell_coordinate(x.y, p.inv_cell, p.cells_y),
          cell_coordinate(x.z, p.inv_cell, p.cells_z)};
}

template <class Real>
PBF_HD int linear_cell(Cell c, const Params<Real>& p) {
  return (c.z * p.cells_y + c.y) * p.cells_x + c.x;
}

/// Calls f(begin, end) for the up to nine runs of particles (rows of three cells along x) that
/// hold every particle within one cell edge of a particle in cell c. `cell_start`: first particle
/// of each cell, and the particle count as last entry. Order: z, then y, then x: canonical.
template <class Real, class F>
PBF_HD void for_each_run(Cell c, const int* cell_start, const Params<Real>& p, F&& f) {
  const int x0 = c.x > 0 ? c.x - 1 : 0, x1 = c.x + 1 < p.cells_x ? c.x + 1 : p.cells_x - 1;
  const int y0 = c.y > 0 ? c.y - 1 : 0, y1 = c.y + 1 < p.cells_y ? c.y + 1 : p.cells_y - 1;
  const int z0 = c.z > 0 ? c.z - 1 : 0, z1 = c.z + 1 < p.cells_z ? c.z + 1 : p.cells_z - 1;
  for (int z = z0; z <= z1; ++z)
    for (int y = y0; y <= y1; ++y) {
      const int row = (z * p.cells_y + y) * p.cells_x;
      f(cell_start[row + x0], cell_start[row + x1 + 1]);
    }
}

}  // namespace pbf
