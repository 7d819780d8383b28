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

/// Whether any loads are summed. Pressure gauges need them: they use a share of a surface's load.
inline bool has_loads(const Scene& scene) {
  // The work of a moving obstacle is computed from its load.
  const auto wanted = [](const Obstacle& o) { return o.loads || o.motion; };
  return scene.domain.loads || has_pressure_gauges(scene) ||
         std::any_of(scene.obstacles.begin(), scene.obstacles.end(), wanted);
}

/// Whether loads on walls are needed. If so, particles near walls are treated as near solids.
inline bool has_wall_loads(const Scene& scene) {
  return scene.domain.loads || has_pressure_on_wall(scene);
}

/// Whether the boundary is more than plain walls.
inline bool has_solids(const Scene& scene) { return !scene.obstacles.empty() || has_loads(scene); }

/// The bits of LoadBook::summed. Includes moving obstacles, whose work is computed from their load.
inline std::uint64_t summed_walls(const Scene& scene) {
  std::uint64_t bits = scene.domain.loads ? 63 : 0;
  for (std::size_t k = 0; k < scene.obstacles.size() && k + kFaceNames.size() < 64; ++k)
    if (scene.obstacles[k].loads || scene.obstacles[k].motion)
      bits |= std::uint64_t(1) << (k + kFaceNames.size());
  return bits;
}

/// The first of the gauges' rows of sums. Before them are the rows of the six faces (0 for open
/// ones) and of all obstacles.
inline std::int64_t first_gauge_row(const Scene& scene) {
  return std::int64_t(kFaceNames.size() + scene.obstacles.size());
}
/// Number of rows of sums.
inline std::int64_t load_walls(const Scene& scene) {
  return has_loads(scene) ? first_gauge_row(scene) + pressure_gauges(scene) : 0;
}

}  // namespace pbf::inline program_module
