// Converts results to SI units and the scene's axes, in the order of ids.
#pragma once

#include <cstddef>

#include "kernels/axes.h"
#include "kernels/params.h"

namespace pbf::PBF_VARIANT {

/// Writes position (3), velocity (3) and density (1) to those pointers that are set.
template <class Real, class Out>
struct ExportPass {
  double h, rest_density, origin[3];  ///< origin: in internal axes
  Axes axes;
  const Vec4<Real>*position, *velocity;
  const Real* density;
  const int* place;                                ///< of each row
  Out *position_out, *velocity_out, *density_out;  ///< null: not needed

  PBF_HD void operator()(int i) const {
    const std::size_t row = std::size_t(place[i]);
    const int x = axes.of[0], y = axes.of[1], z = axes.of[2];
    if (position_out) {
      Out* to = position_out + 3 * row;
      to[x] = Out(origin[0] + h * double(position[i].x));
      to[y] = Out(origin[1] + h * double(position[i].y));
      to[z] = Out(origin[2] + h * double(position[i].z));
    }
    if (velocity_out) {
      Out* to = velocity_out + 3 * row;
      to[x] = Out(h * double(velocity[i].x));
      to[y] = Out(h * double(velocity[i].y));
      to[z] = Out(h * double(velocity[i].z));
    }
    if (density_out) density_out[row] = Out(rest_density * double(density[i]));
  }
};

}  // namespace pbf::PBF_VARIANT
