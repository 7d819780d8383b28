#include "lib/program/calibrate.h"

#include <cmath>

#include "kernels/boundary/box.h"

namespace pbf::program_module {
namespace {

template <Smoothing S>
Calibration calibrated(double ratio) {
  const int reach = int(std::ceil(ratio)), reach_y = dimensions_of(S) == 2 ? 0 : reach;
  double sum = 0, above = 0;  // whole lattice; the layers at and above the particle's own
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach_y; y <= reach_y; ++y)
      for (int x = -reach; x <= reach; ++x) {
        const double q_squared = (x * x + y * y + z * z) / (ratio * ratio);
        const double w =
            density_norm<double, S>() *
            density_shape<double, S>(q_squared, Spiky<double>::t(std::sqrt(q_squared)));
        sum += w;
        if (z >= 0) above += w;
      }
  Calibration c;
  c.vol = 1 / sum;
  c.wall_range = kWallRange;
  c.wall_scale =
      (1 - c.vol * above) / density_half_space<double, S>(0.5 / ratio / c.wall_range).density;
  return c;
}

}  // namespace

Calibration calibrate(KernelMode mode, double ratio, int dimensions) {
  const bool paper = mode == KernelMode::paper;
  if (dimensions == 2)
    return paper ? calibrated<Smoothing::paper_2d>(ratio)
                 : calibrated<Smoothing::consistent_2d>(ratio);
  return paper ? calibrated<Smoothing::paper>(ratio) : calibrated<Smoothing::consistent>(ratio);
}

}  // namespace pbf::program_module
