// Sponges: zones in which velocities decay, v <- v/(1 + rate s^n dt), so that waves end there.
// s grows from 0 to 1 towards a face of the zone. Implicit in time: no rate is unstable.
#pragma once

#include "kernels/dissipation.h"
#include "kernels/params.h"
#include "kernels/rows.h"

namespace pbf {

inline constexpr int kMostSponges = 8;

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// In the internal frame, lengths in h.
template <class Real>
struct SpongeZone {
  Vec3<Real> low, high;
  Vec3<Real> rise;    ///< 1/h: s = dot(rise, x) + from
  Real from = 0;      ///< s at the origin
  Real rate = 0;      ///< 1/s, where s is 1
  int profile = 2;    ///< n, 1 to 4
  Vec3<Real> damped;  ///< 1 for each axis whose velocity decays, else 0

  /// The factor on the velocity at x after dt (s); 1 outside the zone.
  PBF_HD Real factor(Vec3<Real> x, Real dt) const {
    if (!(x.x >= low.x && x.y >= low.y && x.z >= low.z && x.x <= high.x && x.y <= high.y &&
          x.z <= high.z))
      return Real(1);
    const Real s = max2(Real(0), min2(Real(1), dot(rise, x) + from));
    Real power = s;  // products, because the last bit of pow() differs between machines
    for (int k = 1; k < profile; ++k) power *= s;
    return Real(1) / (Real(1) + rate * dt * power);
  }
};

/// Between updates. In second order the last push stays as it is: it is what holds the fluid
/// against gravity, and no motion.
template <class Real>
struct SpongePass {
  SpongeZone<Real> zone[kMostSponges];
  int zones;
  Real dt;  ///< s, of the update
  OwnRows<const Vec4<Real>> position;
  OwnRows<Vec4<Real>> velocity;  ///< in/out
  Vec4<Real>* free;              ///< in/out; null in first order
  DissipationBook book;

  PBF_HD void operator()(int i) const {
    const Vec3<Real> x = xyz(position[i]);
    for (int k = 0; k < zones; ++k) {
      const Real f = zone[k].factor(x, dt);
      if (f == Real(1)) continue;
      const Vec3<Real> before = xyz(velocity[i]), after = damp(before, zone[k].damped, f);
      velocity[i] = with_w(after, Real(0));
      if (free) free[i] = with_w(xyz(free[i]) + (after - before), Real(0));
      book.add(i, 0.5 * (double(dot(before, before)) - double(dot(after, after))));
    }
  }

 private:
  PBF_HD static Vec3<Real> damp(Vec3<Real> v, Vec3<Real> damped, Real f) {
    return {damped.x > Real(0) ? f * v.x : v.x, damped.y > Real(0) ? f * v.y : v.y,
            damped.z > Real(0) ? f * v.z : v.z};
  }
};

}  // namespace pbf::PBF_VARIANT
