#include "lib/program/obstacles.h"

#include <algorithm>
#include <cmath>

#include "lib/program/motion.h"
#include "lib/scene/vector3.h"

namespace pbf::inline program_module {
namespace {

/// As unit(), of any size: scaled first, so that no square overflows.
Double3 direction(const Double3& v) {
  const double most = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  const double size = most * std::hypot(v[0] / most, v[1] / most, v[2] / most);
  return {v[0] / size, v[1] / size, v[2] / size};
}

/// Rows: the axes of a body that was turned about `axis`.
Matrix3 axes_turned(const Double3& axis, double degrees) {
  if (degrees == 0) return kUnit3;
  const Double3 u = direction(axis);
  const double quarter = degrees / 90;
  // Quarters exactly, so that faces at right angles stay so.
  const bool whole = quarter == std::round(quarter);
  const int turns = int(std::fmod(std::fmod(std::round(quarter), 4) + 4, 4));
  const double angle = degrees * 3.14159265358979323846 / 180;
  const double c = whole ? (turns % 2 ? 0 : 1 - turns) : std::cos(angle);
  const double s = whole ? (turns % 2 ? 2 - turns : 0) : std::sin(angle);
  Matrix3 rows;
  for (std::size_t k = 0; k < 3; ++k) rows[k] = turned(kUnit3[k], u, c, s);
  return rows;
}

/// Rows: a right-handed frame with `axis` as its last one, and along a coordinate where that is.
Matrix3 frame_along(const Double3& axis) {
  const Double3 z = direction(axis);
  std::size_t least = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::fabs(z[k]) < std::fabs(z[least])) least = k;
  const Double3 y = direction(cross(z, kUnit3[least]));
  return {cross(y, z), y, z};
}

/// Where faces of the body, at right angles to its axes, lie on walls or behind them.
unsigned behind_walls(const Scene& s, const Matrix3& rows, const Double3& center,
                      const Double3& half, unsigned faces) {
  unsigned through = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::fabs(rows[axis][k]) < 1) continue;  // not along coordinate k
      for (const int side : {-1, 1}) {
        const unsigned bit = (side < 0 ? 1u : 2u) << (2 * axis);
        const double along = side * rows[axis][k], at = center[k] + along * half[axis];
        const double slack = 1e-9 * (s.domain.max[k] - s.domain.min[k]);
        const bool reached =
            along < 0 ? at <= s.domain.min[k] + slack : at >= s.domain.max[k] - slack;
        if ((faces & bit) && reached && !s.domain.is_open(int(k), along > 0)) through |= bit;
      }
    }
  return through;
}

Solid<double> solid_of(const Obstacle& o, const Scene& s, double time) {
  Solid<double> out;
  out.shape = o.shape;
  Matrix3 rows = kUnit3;
  Double3 center{}, half{};
  unsigned faces = 0;
  switch (o.shape) {
    case ObstacleShape::plane:
      rows = frame_along(o.normal);
      center = o.point;
      break;
    case ObstacleShape::box:
      rows = axes_turned(o.turn_axis, o.turn_angle);
      for (std::size_t k = 0; k < 3; ++k) {
        center[k] = 0.5 * o.min[k] + 0.5 * o.max[k];
        half[k] = 0.5 * (o.max[k] - o.min[k]);
      }
      faces = 63;
      break;
    case ObstacleShape::sphere:
      center = o.center;
      half[0] = o.radius;
      break;
    case ObstacleShape::cylinder:
    case ObstacleShape::capsule: {
      Double3 along{};
      for (std::size_t k = 0; k < 3; ++k) {
        center[k] = 0.5 * o.from[k] + 0.5 * o.to[k];
        along[k] = o.to[k] - o.from[k];
      }
      rows = frame_along(along);
      half = {o.radius, 0, 0.5 * std::hypot(along[0], along[1], along[2])};
      faces = 48;
      break;
    }
  }
  if (o.motion) {
    const Pose pose = pose_of(s, o, time);
    center = pose.of(center);
    for (Double3& axis : rows)
      axis = {dot(pose.turn[0], axis), dot(pose.turn[1], axis), dot(pose.turn[2], axis)};
  }
  if (s.plane()) center[1] = *s.plane();  // no y counts there
  out.through = behind_walls(s, rows, center, half, faces);
  const double h = s.h();
  const Double3 from = s.origin();
  out.center = {(center[0] - from[0]) / h, (center[1] - from[1]) / h, (center[2] - from[2]) / h};
  out.half = {half[0] / h, half[1] / h, half[2] / h};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k) out.turn[r][k] = rows[r][k];
  return out;
}

}  // namespace

std::vector<Solid<double>> solids_of(const Scene& scene, double time) {
  std::vector<Solid<double>> all;
  for (const Obstacle& o : scene.obstacles) all.push_back(solid_of(o, scene, time));
  return all;
}

std::vector<Solid<double>> solids_of(const Scene& scene, const Axes& axes, double time) {
  std::vector<Solid<double>> all = solids_of(scene, time);
  for (Solid<double>& s : all) {
    const Solid<double> along_scene = s;
    const double center[3] = {s.center.x, s.center.y, s.center.z};
    s.center = {center[axes.of[0]], center[axes.of[1]], center[axes.of[2]]};
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 3; ++k) s.turn[r][k] = along_scene.turn[r][axes.of[k]];
  }
  return all;
}

}  // namespace pbf::inline program_module
