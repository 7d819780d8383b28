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
