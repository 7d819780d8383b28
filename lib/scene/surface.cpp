#include "lib/scene/surface.h"

#include <algorithm>
#include <cmath>

#include "lib/scene/vector3.h"

namespace pbf::inline scene_module {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

/// Of a box along the axes about 0 with these half edges, along the first `axes` of them.
SurfacePlace on_box(const Double3& p, const Double3& half, bool flat) {
  SurfacePlace out;
  out.point = p;
  std::size_t face = 0;
  double most = -1e300;
  for (std::size_t k = 0; k < 3; ++k) {
    if (flat && k == 1) continue;
    const double beyond = std::fabs(p[k]) - half[k];
    if (beyond > most) most = beyond, face = k;
    if (beyond > 0) out.point[k] = std::copysign(half[k], p[k]);
  }
  if (most <= 0) out.point[face] = std::copysign(half[face], p[face]);
  out.normal[face] = std::copysign(1.0, p[face]);
  out.distance = most > 0 ? length(p - out.point) : most;
  return out;
}

/// Of a ball: `foot` is its centre, or the nearest place of an axis.
SurfacePlace on_ball(const Double3& at, const Double3& foot, double radius) {
  const Double3 away = at - foot;
  const double r = length(away);
  SurfacePlace out;
  out.normal = r > 0 ? (1 / r) * away : Double3{1, 0, 0};
  out.point = foot + radius * out.normal;
  out.distance = r - radius;
  return out;
}

SurfacePlace on_tube(const Obstacle& o, const Double3& at, bool flat) {
  const Double3 axis = unit(o.to - o.from);
  const double half = length(o.to - o.from) / 2;
  const Double3 middle = 0.5 * (o.from + o.to);
  const double z = dot(at - middle, axis);
  if (o.shape == ObstacleShape::capsule)
    return on_ball(at, middle + std::clamp(z, -half, half) * axis, o.radius);
  const SurfacePlace side = on_ball(at, middle + z * axis, o.radius);
  const double beyond = std::fabs(z) - half, sign = z < 0 ? -1 : 1;
  if (flat || (beyond <= 0 && side.distance >= beyond)) return side;
  SurfacePlace end;
  end.point = at - (sign * beyond) * axis;
  if (side.distance > 0) end.point = end.point - side.distance * side.normal;
  end.normal = sign * axis;
  end.distance =
      beyond > 0 || side.distance > 0 ? length(at - end.point) : std::max(beyond, side.distance);
  if (beyond <= side.distance) end.normal = side.normal;
  return end;
}

}  // namespace

SurfacePlace nearest_place(const Obstacle& o, const Scene& scene, Double3 at) {
  const auto plane = scene.plane();
  const bool flat = bool(plane);
  const auto in_plane = [&](Double3 v) {
    if (plane) v[1] = *plane;
    return v;
  };
  at = in_plane(at);
  switch (o.shape) {
    case ObstacleShape::plane: {
      SurfacePlace out;
      out.normal = unit(o.normal);
      out.distance = dot(at - in_plane(o.point), out.normal);
      out.point = at - out.distance * out.normal;
      return out;
    }
    case ObstacleShape::box: {
      const Double3 middle = in_plane(0.5 * (o.min + o.max)), half = 0.5 * (o.max - o.min);
      const Double3 axis = unit(o.turn_axis);
      const double angle = o.turn_angle * kDegree;
      SurfacePlace out = on_box(turned(at - middle, axis, -angle), half, flat);
      out.point = middle + turned(out.point, axis, angle);
      out.normal = turned(out.normal, axis, angle);
      return out;
    }
    case ObstacleShape::sphere:
      return on_ball(at, in_plane(o.center), o.radius);
    case ObstacleShape::cylinder:
    case ObstacleShape::capsule:
      break;
  }
  Obstacle tube = o;
  if (plane && o.shape == ObstacleShape::capsule)
    tube.from = in_plane(o.from), tube.to = in_plane(o.to);
  return on_tube(tube, at, flat);
}

SurfacePlace nearest_place(int face, const Scene& scene, Double3 at) {
  const auto axis = std::size_t(face / 2);
  const bool high = face % 2 == 1;
  const double wall = (high ? scene.domain.max : scene.domain.min)[axis];
  if (const auto plane = scene.plane()) at[1] = *plane;
  SurfacePlace out;
  out.normal[axis] = high ? -1 : 1;
  out.distance = out.normal[axis] * (at[axis] - wall);
  out.point = at;
  out.point[axis] = wall;
  return out;
}

std::optional<int> surface_named(const Scene& scene, const std::string& name) {
  const auto face = std::find(kFaceNames.begin(), kFaceNames.end(), name);
  if (face != kFaceNames.end()) return int(face - kFaceNames.begin());
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    if (scene.obstacles[k].name == name) return int(kFaceNames.size() + k);
  return std::nullopt;
}

bool has_pressure_on_wall(const Scene& scene) {
  return std::any_of(scene.gauges.begin(), scene.gauges.end(), [](const Gauge& g) {
    return g.kind == GaugeKind::pressure &&
           std::find(kFaceNames.begin(), kFaceNames.end(), g.on) != kFaceNames.end();
  });
}

SurfacePlace nearest_place_on(int surface, const Scene& scene, const Double3& at) {
  const int faces = int(kFaceNames.size());
  if (surface < faces) return nearest_place(surface, scene, at);
  return nearest_place(scene.obstacles[std::size_t(surface - faces)], scene, at);
}

bool is_free(const Scene& scene, const Double3& at, double slack) {
  for (std::size_t k = 0; k < 3; ++k)
    if (!(scene.dimensions == 2 && k == 1) &&
        !(at[k] >= scene.domain.min[k] - slack && at[k] <= scene.domain.max[k] + slack))
      return false;
  return std::none_of(scene.obstacles.begin(), scene.obstacles.end(), [&](const Obstacle& o) {
    return nearest_place(o, scene, at).distance < -slack;
  });
}

int level_axis(const Scene& scene) {
  std::size_t most = 2;
  for (const std::size_t k : {std::size_t(0), std::size_t(1)})
    if (std::fabs(scene.gravity[k]) > std::fabs(scene.gravity[most])) most = k;
  return int(most);
}

std::vector<int> axes_across_level(const Scene& scene) {
  std::vector<int> axes;
  for (int k = 0; k < 3; ++k)
    if (k != level_axis(scene) && !(scene.dimensions == 2 && k == 1)) axes.push_back(k);
  return axes;
}

}  // namespace pbf::inline scene_module
