// Internal frame -> SI units in id order: what leaves the solver.
#pragma once

#include <cstddef>

#include "kernels/params.h"

namespace pbf::inline PBF_VARIANT {

/// position (3), and where the pointers are set velocity (3) and density (1); row = id.
template <class Real, class Out>
struct ExportPass {
  double h, rest_density, origin[3];
  const Vec4<Real>*position, *velocity;
  const Real* density;
  const int* id;
  Out *position_out, *velocity_out, *density_out;  ///< null: not asked for

  PBF_HD void operator()(int i) const {
    const std::size_t row = std::size_t(id[i]);
    if (position_out) {
      position_out[3 * row + 0] = Out(origin[0] + h * double(position[i].x));
      position_out[3 * row + 1] = Out(origin[1] + h * double(position[i].y));
      position_out[3 * row + 2] = Out(origin[2] + h * double(position[i].z));
    }
    if (velocity_out) {
      velocity_out[3 * row + 0] = Out(h * double(velocity[i].x));
      velocity_out[3 * row + 1] = Out(h * double(velocity[i].y));
      velocity_out[3 * row + 2] = Out(h * double(velocity[i].z));
    }
    if (density_out) density_out[row] = Out(rest_density * double(density[i]));
  }
};

}  // namespace pbf::inline PBF_VARIANT
