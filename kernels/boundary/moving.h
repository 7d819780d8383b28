// What changes from step to step where solids move, or the tank: lies in device memory, a row for
// each step of a batch, so that recorded steps find what is theirs.
#pragma once

#include "kernels/boundary/obstacle.h"
#include "kernels/vec3.h"

namespace pbf::inline PBF_VARIANT {

/// How a velocity changes in a step of a tank that moves, apart from damping:
///   v + turn v + pull (x - pivot) + push.
/// It is the step x(n+1) = 2 x(n) - x(n-1) + g dt^2 of a frame at rest, seen from the tank. So a
/// free particle goes straight in that frame, to rounding, and nothing pumps energy: turn + 1 is
/// the rotation by which the tank's turn in two steps is taken back (Coriolis), pull what
/// differences of second order make of the tank's turn (Euler and centrifugal), push gravity,
/// turned, without the acceleration of the pivot.
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

/// How the points of a solid move in an update: linear + angular x x, x from the domain's lower
/// corner.
struct SolidVelocity {
  bool moves = false;             ///< else all is 0
  double linear[3] = {0, 0, 0};   ///< h/s
  double angular[3] = {0, 0, 0};  ///< 1/s
  double middle[3] = {0, 0, 0};   ///< h: where it is in the middle of the update
};

}  // namespace pbf::inline PBF_VARIANT
