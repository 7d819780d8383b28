// The change of the step length in time steps of second order. kernels/README.md, "Second order in
// time".
#pragma once

#include "kernels/boundary/loads.h"
#include "kernels/boundary/moving.h"
#include "kernels/params.h"
#include "kernels/rows.h"

namespace pbf {

/// Length of the step that led to a state: its velocities are those of half a step earlier.
struct StepLength {
  double dt = 0;  ///< s; 0: there was no step, so velocities are those of the state's own time

  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    f(s.dt);
  }
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// Moves velocities from half of the last step before the present time to half of the next step
/// before it, and the push of the last step to the length of the next one. `tank`: of the next
/// step, if the tank moves.
template <class Real>
struct ChangeStepPass {
  Params<Real> p;
  const StepLength* last;
  bool tank_moves;
  FrameStep<double> tank;
  OwnRows<const Vec4<Real>> position;
  OwnRows<Vec4<Real>> velocity, free;  ///< in/out

  PBF_HD void operator()(int i) const {
    const Real old = Real(last->dt), half(0.5);
    if (old == p.dt) return;
    const Vec3<Real> v = xyz(velocity[i]), gained = gain(xyz(position[i]), v);
    if (!(old > Real(0))) {
      velocity[i] = free[i] = with_w(v - half * gained, Real(0));
      return;
    }
    const Real ratio = p.dt / old;
    const Vec3<Real> push = ratio * (v - xyz(free[i]));
    const Vec3<Real> now = v - half * (Real(1) - old / p.dt) * (gained + push);
    velocity[i] = with_w(now, Real(0));
    free[i] = with_w(now - push, Real(0));
  }

 private:
  /// By gravity, or in the frame of the tank, in the next step.
  PBF_HD Vec3<Real> gain(Vec3<Real> x, Vec3<Real> v) const {
    if (!tank_moves) return p.dt * p.gravity;
    const Vec3<double> u{double(v.x), double(v.y), double(v.z)};
    const Vec3<double> d = tank.accelerated({double(x.x), double(x.y), double(x.z)}, u) - u;
    return {Real(d.x), Real(d.y), Real(d.z)};
  }
};

/// The same for the pushes of walls, which are displacements.
struct ChangeWallPushPass {
  const StepLength* last;
  double dt;  ///< s, of the next step
  WallPush* push;
  PBF_HD void operator()(int wall) const {
    if (!(last->dt > 0)) {
      push[wall] = {};
      return;
    }
    const double ratio = dt / last->dt;
    for (int k = 0; k < 3; ++k) {
      push[wall].way[k] *= ratio * ratio;
      push[wall].moment[k] *= ratio * ratio;
    }
  }
};

struct SetStepLengthPass {
  StepLength* last;
  double dt;
  PBF_HD void operator()(int) const { last->dt = dt; }
};

}  // namespace pbf::PBF_VARIANT
