// The power of the tank's motion on the fluid.
#pragma once

#include "kernels/boundary/moving.h"
#include "kernels/measure.h"

namespace pbf::PBF_VARIANT {

/// Sums v . f over the particles. f (h/s^2) is the acceleration by the motion of the tank in
/// addition to gravity, without the Coriolis term, which does no work. The sum is returned
/// as x[0] of a measurement.
template <class Real>
struct PowerPass {
  FrameStep<double> frame;  ///< of a step of `dt`
  double inv_dt;
  Vec3<double> gravity;  ///< h/s^2, as the scene has it
  double lag;            ///< s, by how much velocities are earlier than positions
  const Vec4<Real>*position, *velocity;

  PBF_HD MeasureCounts counts(int i) const {
    MeasureCounts s;
    const double p = power(i);
    s.x_size[0] = p < 0 ? -p : p;
    return s;
  }
  PBF_HD MeasureTerms terms(int i, const MeasureUnits& unit) const {
    MeasureTerms s;
    s.x[0] = fixed_term(power(i) * power_of_two(-unit.x[0]));
    return s;
  }

 private:
  PBF_HD double power(int i) const {
    const Vec4<Real>&x = position[i], &v = velocity[i];
    const Vec3<double> u{double(v.x), double(v.y), double(v.z)};
    const Vec3<double> f =
        inv_dt * frame.accelerated(Vec3<double>{double(x.x), double(x.y), double(x.z)} - lag * u,
                                   Vec3<double>{}) -
        gravity;
    const double p = dot(u, f);
    return is_finite(p) ? p : 0;
  }
};

}  // namespace pbf::PBF_VARIANT
