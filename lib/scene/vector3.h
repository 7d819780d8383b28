// Vector algebra in double, for cameras and obstacles.
#pragma once

#include <cmath>

#include "lib/scene/motion.h"

namespace pbf::scene_module {

inline Double3 operator+(const Double3& a, const Double3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Double3 operator-(const Double3& a, const Double3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Double3 operator*(double s, const Double3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Double3& a, const Double3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Double3& a) { return std::sqrt(dot(a, a)); }
inline Double3 unit(const Double3& a) { return (1 / length(a)) * a; }
/// `v` rotated about the unit axis by an angle of cosine c and sine s (Rodrigues).
inline Double3 turned(const Double3& v, const Double3& axis, double c, double s) {
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}
inline Double3 turned(const Double3& v, const Double3& axis, double angle) {
  return turned(v, axis, std::cos(angle), std::sin(angle));
}

}  // namespace pbf::scene_module
