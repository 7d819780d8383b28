// One particle's share of the sums that a run reports.
#pragma once

#include "kernels/measure_sums.h"
#include "kernels/params.h"
#include "kernels/step_counts.h"

namespace pbf::inline PBF_VARIANT {

/// One particle's share. A non-finite particle counts as such and nowhere else.
template <class Real, class Lists>
struct MeasurePass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>*position, *velocity;
  const Real* density;
  const StepCounts* counts;

  PBF_HD MeasureSums operator()(int i) const {
    MeasureSums s;
    if (i == 0) {
      s.fast = std::int64_t(counts->fast);
      s.rounds = std::int64_t(counts->rounds);
    }
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
    s.above_1 = c > 0.01 ? 1 : 0;
    s.above_10 = c > 0.1 ? 1 : 0;
    if (p.rest.axis >= 0) {
      const double height = p.rest.up * (xs[p.rest.axis] - p.rest.floor);
      for (int k = 0; k < MeasureSums::levels; ++k) {
        const double level = p.rest.depth * (k + 1) / MeasureSums::levels;
        s.below[k] = min2(max2((level - height) / p.rest.spacing + 0.5, 0.0), 1.0);
      }
    }
    const double high[3] = {p.box.x, p.box.y, p.box.z};
    for (int k = 0; k < 3; ++k) {
      const double margin = p.margin;
      if (p.walls & (1u << (2 * k))) s.penetration = max2(s.penetration, margin - xs[k]);
      if (p.walls & (2u << (2 * k)))
        s.penetration = max2(s.penetration, xs[k] - (high[k] - margin));
    }
    s.neighbors = s.neighbors_max = lists.size(i);
    const bool out = ((p.walls & x_min) && x.x < Real(0)) || ((p.walls & x_max) && x.x > p.box.x) ||
                     ((p.walls & y_min) && x.y < Real(0)) || ((p.walls & y_max) && x.y > p.box.y) ||
                     ((p.walls & z_min) && x.z < Real(0)) || ((p.walls & z_max) && x.z > p.box.z);
    s.outside = out ? 1 : 0;
    return s;
  }
};

}  // namespace pbf::inline PBF_VARIANT
