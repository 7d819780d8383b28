// Rotations by quaternions: an oracle for those of the program, which are made otherwise.
#pragma once

#include <cmath>

#include "lib/scene/particles.h"

namespace pbf::test {

/// v turned about the unit axis u by an angle in radians.
inline Double3 by_quaternion(const Double3& u, double angle, const Double3& v) {
  const double w = std::cos(angle / 2), s = std::sin(angle / 2);
  const Double3 q{s * u[0], s * u[1], s * u[2]};
  const auto cross = [](const Double3& a, const Double3& b) {
    return Double3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Double3 t = cross(q, v), tt = cross(q, t);
  return {v[0] + 2 * (w * t[0] + tt[0]), v[1] + 2 * (w * t[1] + tt[1]),
          v[2] + 2 * (w * t[2] + tt[2])};
}

}  // namespace pbf::test
