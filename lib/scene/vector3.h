// Vector algebra in double, for cameras and obstacles, and the axes of a body from its keys.
#pragma once

#include <algorithm>
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

using Matrix3 = std::array<Double3, 3>;  ///< rows
inline constexpr Matrix3 kUnit3{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
inline Double3 times(const Matrix3& m, const Double3& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

/// As unit(), for any length: scaled first, so that no square overflows.
inline Double3 direction(const Double3& v) {
  const double most = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  const double size = most * std::hypot(v[0] / most, v[1] / most, v[2] / most);
  return {v[0] / size, v[1] / size, v[2] / size};
}

/// Rows: the axes of a body that was rotated about `axis`.
inline Matrix3 axes_turned(const Double3& axis, double degrees) {
  if (degrees == 0) return kUnit3;
  const Double3 u = direction(axis);
  const double quarter = degrees / 90;
  // Multiples of 90 degrees are exact, so that right angles stay exact.
  const bool whole = quarter == std::round(quarter);
  const int turns = int(std::fmod(std::fmod(std::round(quarter), 4) + 4, 4));
  const double angle = degrees * 3.14159265358979323846 / 180;
  const double c = whole ? (turns % 2 ? 0 : 1 - turns) : std::cos(angle);
  const double s = whole ? (turns % 2 ? 2 - turns : 0) : std::sin(angle);
  Matrix3 rows;
  for (std::size_t k = 0; k < 3; ++k) rows[k] = turned(kUnit3[k], u, c, s);
  return rows;
}

/// Rows: a right-handed frame whose last row is `axis`; aligned with coordinates if `axis` is.
inline Matrix3 frame_along(const Double3& axis) {
  const Double3 z = direction(axis);
  std::size_t least = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::fabs(z[k]) < std::fabs(z[least])) least = k;
  const Double3 y = direction(cross(z, kUnit3[least]));
  return {cross(y, z), y, z};
}

}  // namespace pbf::scene_module
