// Sums over all particles that a run reports, in double on every backend and in both precisions.
#pragma once

#include <cstdint>

#include "kernels/params.h"

namespace pbf {

/// Partial sums in the internal frame (h, s, rho0); lib/diag turns the total into SI units.
struct MeasureSums {
  double compression = 0, compression_squared = 0, compression_max = 0;
  double speed_squared = 0, speed_squared_max = 0;
  double x[3] = {0, 0, 0}, v[3] = {0, 0, 0}, front[3] = {-1e300, -1e300, -1e300};
  std::int64_t neighbors = 0, neighbors_max = 0, outside = 0, non_finite = 0;

  PBF_HD void add(const MeasureSums& o) {
    compression += o.compression;
    compression_squared += o.compression_squared;
    compression_max = max2(compression_max, o.compression_max);
    speed_squared += o.speed_squared;
    speed_squared_max = max2(speed_squared_max, o.speed_squared_max);
    for (int k = 0; k < 3; ++k) {
      x[k] += o.x[k];
      v[k] += o.v[k];
      front[k] = max2(front[k], o.front[k]);
    }
    neighbors += o.neighbors;
    neighbors_max = max2(neighbors_max, o.neighbors_max);
    outside += o.outside;
    non_finite += o.non_finite;
  }
};

/// One particle's share. A non-finite particle counts as such and nowhere else.
template <class Real, class Lists>
struct MeasurePass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>*position, *velocity;
  const Real* density;

  PBF_HD MeasureSums operator()(int i) const {
    MeasureSums s;
    const Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    if (!is_finite(x.x + x.y + x.z) || !is_finite(dot(v, v)) || !is_finite(density[i])) {
      s.non_finite = 1;
      return s;
    }
    const double c = max2(double(density[i]) - 1, 0.0);
    const double xs[3] = {x.x, x.y, x.z}, vs[3] = {v.x, v.y, v.z};
    s.compression = c;
    s.compression_squared = c * c;
    s.compression_max = c;
    s.speed_squared = vs[0] * vs[0] + vs[1] * vs[1] + vs[2] * vs[2];
    s.speed_squared_max = s.speed_squared;
    for (int k = 0; k < 3; ++k) {
      s.x[k] = s.front[k] = xs[k];
      s.v[k] = vs[k];
    }
    s.neighbors = s.neighbors_max = lists.size(i);
    const bool out = ((p.walls & x_min) && x.x < Real(0)) || ((p.walls & x_max) && x.x > p.box.x) ||
                     ((p.walls & y_min) && x.y < Real(0)) || ((p.walls & y_max) && x.y > p.box.y) ||
                     ((p.walls & z_min) && x.z < Real(0)) || ((p.walls & z_max) && x.z > p.box.z);
    s.outside = out ? 1 : 0;
    return s;
  }
};

}  // namespace pbf
