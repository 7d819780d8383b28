// Obstacles of scenes by words that tests write short.
#pragma once

#include <initializer_list>

#include "kernels/boundary/obstacle.h"
#include "lib/scene/scene.h"

namespace pbf_test {

/// In the order of the program's list.
enum class ObstacleShape { plane, box, sphere, cylinder, capsule };
inline ObstacleShape shape_of(const pbf::Obstacle& o) { return ObstacleShape(o.shape.index()); }

inline pbf::obstacle_keys::Box& box_of(pbf::Obstacle& o) { return o.as<pbf::obstacle_keys::Box>(); }
inline const pbf::obstacle_keys::Box& box_of(const pbf::Obstacle& o) {
  return o.as<pbf::obstacle_keys::Box>();
}
/// The axis and radius of a cylinder or a capsule.
inline pbf::obstacle_keys::Tube& tube_of(pbf::Obstacle& o) {
  if (auto* cylinder = std::get_if<pbf::obstacle_keys::Cylinder>(&o.shape)) return *cylinder;
  return o.as<pbf::obstacle_keys::Capsule>();
}

/// The ends of its axis along which the solid goes on behind walls, as bits of WallBit.
inline unsigned through_of(const pbf::Solid<double>& solid) {
  return solid.shape.with([](const auto& body) {
    if constexpr (requires { body.through; }) return body.through;
    return 0u;
  });
}

/// Its keys that are places.
inline std::vector<pbf::Double3*> places_in(pbf::Obstacle& o) {
  std::vector<pbf::Double3*> all;
  const auto add = [&](auto& keys, const auto& key) {
    if constexpr (std::is_same_v<decltype(&(keys.*key.member)), pbf::Double3*>)
      if (key.unit == std::string("m")) all.push_back(&(keys.*key.member));
  };
  std::visit(
      [&](auto& keys) {
        std::apply([&](const auto&... key) { (add(keys, key), ...); }, keys.keys());
      },
      o.shape);
  return all;
}

inline pbf::Obstacle obstacle_of(pbf::obstacle_keys::Any shape) {
  pbf::Obstacle o;
  o.shape = std::move(shape);
  return o;
}
inline pbf::Obstacle box_obstacle(const pbf::Double3& min, const pbf::Double3& max,
                                  const pbf::Double3& axis = {0, 0, 1}, double degrees = 0) {
  return obstacle_of(pbf::obstacle_keys::Box{min, max, axis, degrees});
}
/// The same box as a mesh.
inline pbf::Obstacle mesh_obstacle(const pbf::obstacle_keys::Box& box) {
  pbf::TriangleMesh m;
  const pbf::Double3 middle = box.middle();
  for (unsigned k = 0; k < 8; ++k) {
    pbf::Double3& x = m.vertex.emplace_back();
    for (std::size_t a = 0; a < 3; ++a)
      x[a] = (k >> a & 1 ? 0.5 : -0.5) * (box.max[a] - box.min[a]);
  }
  m.triangle = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  pbf::obstacle_keys::Mesh mesh;
  mesh.translate = middle, mesh.turn_axis = box.turn_axis, mesh.turn_angle = box.turn_angle;
  mesh.surface = std::make_shared<const pbf::SolidMesh>("box", "", std::move(m));
  return obstacle_of(mesh);
}
inline pbf::Obstacle sphere_obstacle(const pbf::Double3& center, double radius) {
  return obstacle_of(pbf::obstacle_keys::Sphere{center, radius});
}
/// A cylinder or a capsule.
inline pbf::Obstacle tube_obstacle(ObstacleShape shape, const pbf::Double3& from,
                                   const pbf::Double3& to, double radius) {
  const pbf::obstacle_keys::Tube tube{from, to, radius};
  return shape == ObstacleShape::cylinder ? obstacle_of(pbf::obstacle_keys::Cylinder{tube})
                                          : obstacle_of(pbf::obstacle_keys::Capsule{tube});
}
inline pbf::Obstacle plane_obstacle(const pbf::Double3& point, const pbf::Double3& normal) {
  return obstacle_of(pbf::obstacle_keys::Plane{point, normal});
}

}  // namespace pbf_test
