// The weight of one particle, from the state of rest.
#pragma once

#include "lib/scene/scene.h"

namespace pbf {

/// vol = m/(rho0 h^3) such that a particle inside the rest lattice (cubic, spacing d = h/ratio)
/// has density rho0 under the density kernel in use; wall_scale such that the particles of a
/// layer at distance d/2 from a plane wall have it too. Lattice sums in double.
/// kernels/README.md (8) and (9). ratio: h/d >= 1.
struct Calibration {
  double vol = 1, wall_scale = 1;
};
Calibration calibrate(KernelMode kernels, double ratio);

}  // namespace pbf
