// One particle's share of the sums that a run reports.
#pragma once

#include "kernels/measure_sums.h"
#include "kernels/params.h"
#include "kernels/step_counts.h"

namespace pbf::inline PBF_VARIANT {

/// One particle's maxima and counts, then its terms. A non-finite particle counts as such and
/// nowhere else.
template <class Real, class Lists>
struct MeasurePass {
  Params<Real> p;
  Lists lists;
  const Vec4<Real>*position, *velocity;
  const Real* density;
  const StepCounts* step_counts;

  PBF_HD MeasureCounts counts(int i) const {
    MeasureCounts s;
    if (i == 0) {
      s.fast = std::int64_t(step_counts->fast);
      s.rounds = std::int64_t(step_counts->rounds);
      s.unresolved = std::int64_t(step_counts->unresolved);
      s.way_squared = step_counts->way_squared;
    }
    if (!finite(i)) {
      s.non_finite = 1;
      return s;
    }
    const Particle a = particle(i);
    s.compression_max = a.compression;
    s.speed_squared_max = a.speed_squared;
    for (int k = 0; k < 3; ++k) {
      s.front[k] = a.x[k] + 0.0;  // one zero: the larger of two must not depend on their order
      s.x_size[k] = a.x[k] < 0 ? -a.x[k] : a.x[k];
      s.v_size[k] = a.v[k] < 0 ? -a.v[k] : a.v[k];
    }
    s.above_1 = a.compression > 0.01 ? 1 : 0;
    s.above_10 = a.compression > 0.1 ? 1 : 0;
    s.penetration = p.boundary.penetration(a.x);
    s.outside = p.boundary.beyond(a.x) ? 1 : 0;
    s.neighbors = s.neighbors_max = lists.size(i);
    return s;
  }

  PBF_HD MeasureTerms terms(int i, const MeasureUnits& unit) const {
    MeasureTerms s;
    if (!finite(i)) return s;
    const Particle a = particle(i);
    const double c = a.compression * power_of_two(-unit.compression);
    s.compression = fixed_term(c);
    s.compression_squared = fixed_term(c * c);
    s.speed_squared = fixed_term(a.speed_squared * power_of_two(-unit.speed_squared));
    for (int k = 0; k < 3; ++k) {
      s.x[k] = fixed_term(a.x[k] * power_of_two(-unit.x[k]));
      s.v[k] = fixed_term(a.v[k] * power_of_two(-unit.v[k]));
    }
    if (p.rest.axis < 0) return s;
    const double height = p.rest.up * (a.x[p.rest.axis] - p.rest.floor);
    for (int k = 0; k < MeasureTerms::levels; ++k) {
      const double level = p.rest.depth * (k + 1) / MeasureTerms::levels;
      s.below[k] = fixed_term(max2((level - height) / p.rest.spacing + 0.5, 0.0));  // at most 1
    }
    return s;
  }

 private:
  struct Particle {
    double x[3], v[3], compression, speed_squared;
  };
  PBF_HD bool finite(int i) const {
    const Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    return is_finite(x.x + x.y + x.z) && is_finite(dot(v, v)) && is_finite(density[i]);
  }
  PBF_HD Particle particle(int i) const {
    const Vec4<Real>&x = position[i], &v = velocity[i];
    Particle a{{x.x, x.y, x.z}, {v.x, v.y, v.z}, max2(double(density[i]) - 1, 0.0), 0};
    a.speed_squared = a.v[0] * a.v[0] + a.v[1] * a.v[1] + a.v[2] * a.v[2];
    return a;
  }
};

}  // namespace pbf::inline PBF_VARIANT
