#include "lib/scene/surface.h"

#include <algorithm>
#include <cmath>

#include "lib/scene/vector3.h"

namespace pbf::scene_module {
Solid<double> solid_in_metres(const Obstacle& o, const Scene& scene) {
  Double3 middle = o.middle();
  if (const auto plane = scene.plane()) middle[1] = *plane;
  Solid<double> solid;
  solid.center = {middle[0], middle[1], middle[2]};
  const Matrix3 axes = o.axes();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) solid.turn[i][k] = axes[i][k];
  solid.shape = std::visit([](const auto& k) -> SomeShape<double> { return k.make(1); }, o.shape);
  return solid;
}

SurfacePlace nearest_place(const Obstacle& o, const Scene& scene, Double3 at) {
  const auto plane = scene.plane();
  if (plane) at[1] = *plane;
  const Solid<double> solid = solid_in_metres(o, scene);
  const Vec3<double> x{at[0], at[1], at[2]};
  const Vec3<double> n = plane ? normal<2>(solid, x) : normal<3>(solid, x);
  SurfacePlace out;
  out.distance = plane ? distance<2>(solid, x) : distance<3>(solid, x);
  out.normal = {n.x, n.y, n.z};
  out.point = at - out.distance * out.normal;
  return out;
}

RoundSide<double> round_side(const Obstacle& o, const Scene& scene, const Double3& at) {
  const Solid<double> solid = solid_in_metres(o, scene);
  const Vec3<double> x{at[0], at[1], at[2]};
  return solid.shape.with([&](const auto& shape) {
    return scene.plane() ? round_of<2>(shape, body_point<2>(solid, x))
                         : round_of<3>(shape, body_point<3>(solid, x));
  });
}

bool is_bent(const Obstacle& o) {
  return std::visit(
      [](const auto& keys) {
        return requires { keys.make(1).template curvature<3>(Vec3<double>{}); };
      },
      o.shape);
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

const Obstacle* obstacle_of(const Scene& scene, int surface) {
  const auto k = std::size_t(surface) - kFaceNames.size();
  return std::size_t(surface) < kFaceNames.size() ? nullptr : &scene.obstacles[k];
}

std::vector<int> loaded_surfaces(const Scene& s) {
  std::vector<int> all;
  for (int face = 0; s.domain.loads && face < int(kFaceNames.size()); ++face)
    if (s.domain.has_wall(face / 2, face % 2 == 1) && !(s.dimensions == 2 && face / 2 == 1))
      all.push_back(face);
  for (std::size_t k = 0; k < s.obstacles.size(); ++k)
    if (s.obstacles[k].loads) all.push_back(int(kFaceNames.size() + k));
  return all;
}

bool has_pressure_on_wall(const Scene& scene) {
  return std::ranges::any_of(scene.gauges, [](const Gauge& g) {
    const auto* keys = std::get_if<gauge_keys::Pressure>(&g.kind);
    return keys && std::ranges::find(kFaceNames, keys->on) != kFaceNames.end();
  });
}

SurfacePlace nearest_place_on(int surface, const Scene& scene, const Double3& at) {
  const Obstacle* o = obstacle_of(scene, surface);
  return o ? nearest_place(*o, scene, at) : nearest_place(surface, scene, at);
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

}  // namespace pbf::scene_module
