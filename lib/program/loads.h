// Which walls of a scene have their loads summed.
#pragma once

#include <algorithm>

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

inline bool has_loads(const Scene& scene) {
  // What moves does work, which is known from its load.
  const auto wanted = [](const Obstacle& o) { return o.loads || o.motion; };
  return scene.domain.loads || std::any_of(scene.obstacles.begin(), scene.obstacles.end(), wanted);
}

/// There is more around the fluid than plain walls.
inline bool has_solids(const Scene& scene) { return !scene.obstacles.empty() || has_loads(scene); }

/// How many have sums: the walls, of which those of open faces stay 0, and all obstacles.
inline std::int64_t load_walls(const Scene& scene) {
  return has_loads(scene) ? std::int64_t(kFaceNames.size() + scene.obstacles.size()) : 0;
}

}  // namespace pbf::inline program_module
