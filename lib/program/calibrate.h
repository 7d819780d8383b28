// The weight of one particle, computed from the rest lattice.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// vol = m/(rho0 h^3) (in two dimensions: over the thickness, m/(rho0 h^2)) such that a particle
/// inside the rest lattice (cubic or square, spacing d = h/ratio) has density rho0 under the
/// density kernel in use (lattice sum in double).
///
/// A wall adds wall_scale * D(q / wall_range) to the density (kernels/boundary/box.h). The scale
/// gives a lattice layer at d/2 from the wall the density rho0. Formulas and the choice of the
/// range: kernels/README.md (8), (9), "Range of the walls". ratio: h/d. lib/solver/DIAGNOSTICS.md
/// shows what a small ratio does to the volume, the reason for least_smoothing_ratio().
struct Calibration {
  double vol = 1, wall_scale = 1, wall_range = 1;
};
Calibration calibrate(KernelMode kernels, double ratio, int dimensions = 3);
/// h, the range of the walls of a scene; with fluid.mass nothing is calibrated.
inline constexpr double kWallRange = 0.7;
inline double wall_range(const Scene& s) { return s.fluid.mass ? 1 : kWallRange; }

}  // namespace pbf::program_module
