// Data that changes from step to step if solids or the tank move. It is in device memory, with a
// row for each step of a batch, so that recorded steps find it.
#pragma once

#include "kernels/boundary/obstacle.h"
#include "kernels/vec3.h"

namespace pbf {

/// The velocity of a point x of a solid in an update: linear + angular x x, with x from the
/// domain's lower corner.
struct SolidVelocity {
  bool moves = false;             ///< else all is 0
  double linear[3] = {0, 0, 0};   ///< h/s
  double angular[3] = {0, 0, 0};  ///< 1/s
  double middle[3] = {0, 0, 0};   ///< h, its position halfway through the update
  bool free = false;              ///< the fluid moves it
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// The change of a velocity in a step of a moving tank, apart from damping:
///   v + turn v + pull (x - pivot) + push.
/// It is the step x(n+1) = 2 x(n) - x(n-1) + g dt^2 of the inertial frame, in the frame of the
/// tank. A free particle therefore moves in a straight line to rounding and gains no energy.
/// turn + 1 is the inverse of the tank's rotation over two steps (Coriolis), pull follows from the
/// second difference of its rotation (Euler and centrifugal), and push is the rotated gravity
/// without the acceleration of the pivot.
template <class Real>
struct FrameStep {
  Real turn[3][3] = {}, pull[3][3] = {};  ///< 1, 1/s
  Vec3<Real> pivot, push;                 ///< h, h/s

  PBF_HD Vec3<Real> accelerated(Vec3<Real> x, Vec3<Real> v) const {
    const Vec3<Real> r = x - pivot;
    const auto row = [&](int k, Real own, Real rest) {
      Real sum = mul_add(pull[k][0], r.x, rest);
      sum = mul_add(pull[k][1], r.y, sum);
      sum = mul_add(pull[k][2], r.z, sum);
      sum = mul_add(turn[k][0], v.x, sum);
      sum = mul_add(turn[k][1], v.y, sum);
      return own + mul_add(turn[k][2], v.z, sum);
    };
    return {row(0, v.x, push.x), row(1, v.y, push.y), row(2, v.z, push.z)};
  }
};

}  // namespace pbf::PBF_VARIANT
