// The weight of one particle, computed from the rest lattice.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// vol = m/(rho0 h^3) (in two dimensions: over the thickness, m/(rho0 h^2)) such that a particle
/// inside the rest lattice (cubic or square, spacing d = h/ratio) has density rho0 under the
/// density kernel in use (lattice sum in double).
///
/// A wall adds wall_scale * D(q / wall_range) to the density (kernels/boundary/box.h). The scale is
/// such that a lattice layer at d/2 from the wall has density rho0. The range: fluid at rest keeps
/// about half a spacing from the wall on either side, so what a particle would see of it behind the
/// wall falls off faster than the half space of a continuum (wall_range 1). Height kept by tanks at
/// rest (h = 2 d, 10x10x16 and 24x24x24 particles), for ranges that all fit the lattice: 1: 0.934
/// and 0.963; 0.855: 0.974 and 0.983; 0.75: 0.989 and 0.991; 0.7: 0.993 and 0.993; 0.64: 0.994 and
/// 0.993. With the continuum's own scale and range 1 it is 0.994 and 0.993 too, but a lattice is
/// then 3 % too dense at the wall and leaps up by 11 % and 3 % at the first updates; with 0.7 it
/// does not. In two dimensions (pools of 10 x 16 and 24 x 24 squares), ranges 1: 0.970 and 0.980;
/// 0.855: 0.986 and 0.989; 0.75: 0.992 and 0.992; 0.7: 0.994 and 0.993; 0.64: 0.994 and 0.993; 0.5:
/// 0.988 and 0.990; with the paper's kernels (10 x 24) 0.992 at 0.7 and less on either side. So it
/// is 0.7 there too. kernels/README.md (8), (9). ratio: h/d; what a small one does to the volume,
/// and why scenes have at least least_smoothing_ratio(): lib/solver/DIAGNOSTICS.md.
struct Calibration {
  double vol = 1, wall_scale = 1, wall_range = 1;
};
Calibration calibrate(KernelMode kernels, double ratio, int dimensions = 3);

}  // namespace pbf::inline program_module
