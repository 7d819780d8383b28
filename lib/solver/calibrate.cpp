#include "lib/solver/calibrate.h"

#include <cmath>

#include "kernels/boundary.h"

namespace pbf {
namespace {

double kernel(KernelMode mode, double q_squared) {
  const double t = Spiky<double>::t(std::sqrt(q_squared));
  return mode == KernelMode::paper
             ? Poly6<double>::norm * density_shape<double, Smoothing::paper>(q_squared, t)
             : Spiky<double>::norm * density_shape<double, Smoothing::consistent>(q_squared, t);
}

}  // namespace

Calibration calibrate(KernelMode mode, double ratio) {
  const int reach = int(std::ceil(ratio));
  double sum = 0, above = 0;  // whole lattice; the layers at and above the particle's own
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x) {
        const double w = kernel(mode, (x * x + y * y + z * z) / (ratio * ratio));
        sum += w;
        if (z >= 0) above += w;
      }
  Calibration c;
  c.vol = 1 / sum;
  c.wall_range = 0.7;
  const double q = 0.5 / ratio / c.wall_range;
  const double half_space =
      (mode == KernelMode::paper ? half_space_poly6(q) : half_space_spiky(q)).density;
  c.wall_scale = (1 - c.vol * above) / half_space;
  return c;
}

}  // namespace pbf
