// The orders of accuracy of time steps as types, so that passes of first order do not pay for the
// second. kernels/README.md, "Second order in time". Passes hold them as plain members: with
// [[no_unique_address]], the compilers for host and device place two empty members differently.
#pragma once

#include "kernels/dissipation.h"
#include "kernels/vec3.h"

namespace pbf::PBF_VARIANT {

struct FirstOrder {
  static constexpr bool second = false;
  DissipationBook damping{};  ///< of predictions
};
template <class Real>
struct SecondOrder {
  static constexpr bool second = true;
  /// h/s, the velocity of each particle without the pushes of the last step. Null in passes that
  /// predict nothing.
  Vec4<Real>* free = nullptr;
  DissipationBook damping{};  ///< of predictions
};

/// The step of a particle so far, for what pushes it. In first order that does not matter.
struct AnyWay {};
template <class Real>
struct StepWay {
  Vec3<Real> way;  ///< h, from where the step began to x*
  Real back;       ///< how far back along it corrections take their direction: 0 at x*, 1 where it
                   ///< began
};

/// Where a wall pushes a particle at x* from: `back` of its way before x*, if that is little. From
/// 0.4 h on it is x*, because a particle that comes so fast is elsewhere in the wall's density.
template <class Real>
PBF_HD Vec3<Real> push_place(Vec3<Real> x, const StepWay<Real>& step) {
  const Real most(0.4);
  const Vec3<Real> w = step.back * step.way;
  const Real left = Real(1) - dot(w, w) * (Real(1) / (most * most));
  return choose(left > Real(0), x - left * w, x);
}
template <class Real>
PBF_HD Vec3<Real> push_place(Vec3<Real> x, AnyWay) {
  return x;
}
/// h, the largest distance of push_place() from x*: w (1 - w^2/0.4^2) has its maximum at
/// w = 0.4/sqrt(3).
constexpr double kPushPlaceAway = 0.154;

}  // namespace pbf::PBF_VARIANT
