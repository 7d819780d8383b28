// Obstacles that the fluid moves: where they are in a scene.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

inline std::int64_t free_bodies(const Scene& scene) {
  return std::ranges::count_if(scene.obstacles, [](const Obstacle& o) { return bool(o.free); });
}
inline bool has_free_bodies(const Scene& scene) { return free_bodies(scene) > 0; }

/// Their names, in the order of obstacles.
inline std::vector<std::string> names_of_bodies(const Scene& scene) {
  std::vector<std::string> names;
  for (const Obstacle& o : scene.obstacles)
    if (o.free) names.push_back(o.name);
  return names;
}

/// Moves the free bodies of the scene to where `bodies` says: one for each, in the order of
/// obstacles. Without any, they are where the scene file puts them.
inline void place_bodies(Scene& scene, const std::vector<BodyMotion>& bodies) {
  auto next = bodies.begin();
  for (Obstacle& o : scene.obstacles)
    if (o.free) o.free->now = next != bodies.end() ? std::optional(*next++) : std::nullopt;
}
inline Scene with_bodies(Scene scene, const std::vector<BodyMotion>& bodies) {
  place_bodies(scene, bodies);
  return scene;
}

/// The scene of a run that begins with its free bodies where `bodies` says, at these velocities;
/// its obstacles then have other keys, and `turn` counts from there. The same places but for
/// rounding.
Scene begun_with_bodies(Scene scene, const std::vector<BodyMotion>& bodies);

}  // namespace pbf::program_module
