// Obstacles that the fluid moves: where they are in a scene.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

inline std::int64_t free_bodies(const Scene& scene) {
  return std::ranges::count_if(scene.obstacles, [](const Obstacle& o) { return bool(o.free); });
}
inline bool has_free_bodies(const Scene& scene) { return free_bodies(scene) > 0; }

/// The scene with its free bodies where `bodies` says: one for each, in the order of obstacles.
/// Without any, they are where the scene file puts them.
inline Scene with_bodies(Scene scene, const std::vector<BodyMotion>& bodies) {
  auto next = bodies.begin();
  for (Obstacle& o : scene.obstacles)
    if (o.free && next != bodies.end()) o.free->now = *next++;
  return scene;
}

}  // namespace pbf::program_module
