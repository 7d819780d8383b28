// Selects the walls, and the gauges on them, whose loads are summed.
#pragma once

#include <algorithm>

#include "lib/scene/surface.h"

namespace pbf::inline program_module {

inline std::int64_t pressure_gauges(const Scene& scene) {
  return std::count_if(scene.gauges.begin(), scene.gauges.end(),
                       [](const Gauge& g) { return g.kind == GaugeKind::pressure; });
}
inline bool has_pressure_gauges(const Scene& scene) { return pressure_gauges(scene) > 0; }

/// Also for the gauges that take their share of a surface's.
inline bool has_loads(const Scene& scene) {
  // What moves does work, which is known from its load.
  const auto wanted = [](const Obstacle& o) { return o.loads || o.motion; };
  return scene.domain.loads || has_pressure_gauges(scene) ||
         std::any_of(scene.obstacles.begin(), scene.obstacles.end(), wanted);
}

/// Those of walls are asked for, too: whoever comes to a wall has to be booked.
inline bool has_wall_loads(const Scene& scene) {
  return scene.domain.loads || has_pressure_on_wall(scene);
}

/// There is more around the fluid than plain walls.
inline bool has_solids(const Scene& scene) { return !scene.obstacles.empty() || has_loads(scene); }

/// As LoadBook::summed. What moves does work, which is known from its load.
inline std::uint64_t summed_walls(const Scene& scene) {
  std::uint64_t bits = scene.domain.loads ? 63 : 0;
  for (std::size_t k = 0; k < scene.obstacles.size() && k + kFaceNames.size() < 64; ++k)
    if (scene.obstacles[k].loads || scene.obstacles[k].motion)
      bits |= std::uint64_t(1) << (k + kFaceNames.size());
  return bits;
}

/// The rows of sums before those of the gauges: the walls, of which those of open faces stay 0, and
/// all obstacles.
inline std::int64_t first_gauge_row(const Scene& scene) {
  return std::int64_t(kFaceNames.size() + scene.obstacles.size());
}
/// How many have sums.
inline std::int64_t load_walls(const Scene& scene) {
  return has_loads(scene) ? first_gauge_row(scene) + pressure_gauges(scene) : 0;
}

}  // namespace pbf::inline program_module
