// The walls, and the gauges on them, whose loads are summed: which, their rows, their readings.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/axes.h"
#include "lib/program/gauges.h"
#include "lib/scene/surface.h"

namespace pbf::program_module {

inline bool has_pressure_gauges(const Scene& scene) { return gauges_of<PatchTally>(scene) > 0; }

/// Whether any loads are summed. Pressure gauges need them: they use a share of a surface's load.
inline bool has_loads(const Scene& scene) {
  // The work of a moving obstacle is computed from its load, and the load moves a free body.
  const auto wanted = [](const Obstacle& o) { return o.loads || o.moves(); };
  return scene.domain.loads || has_pressure_gauges(scene) ||
         std::any_of(scene.obstacles.begin(), scene.obstacles.end(), wanted);
}

/// Whether loads on walls are needed. If so, particles near walls are treated as near solids.
inline bool has_wall_loads(const Scene& scene) {
  return scene.domain.loads || has_pressure_on_wall(scene);
}

/// Whether the boundary is more than plain walls.
inline bool has_solids(const Scene& scene) {
  return !scene.obstacles.empty() || !scene.emitters.empty() || has_loads(scene);
}

// Rows of sums and of loads: those of the six faces along the internal axes (0 for open ones), then
// those of all obstacles, then those of the gauges on them.

/// Of a surface (surface_named()).
inline int load_row(int surface, const Axes& axes) {
  const int faces = int(kFaceNames.size());
  return surface < faces ? 2 * axes.inside(surface / 2) + surface % 2
                         : load_row_of_solid(surface - faces);
}
/// Of the k-th gauge.
inline int load_row_of_patch(const Scene& scene, int k) {
  return load_row_of_solid(int(scene.obstacles.size())) + k;
}
/// Number of rows.
inline std::int64_t load_walls(const Scene& scene) {
  return has_loads(scene) ? load_row_of_patch(scene, gauges_of<PatchTally>(scene)) : 0;
}

/// The bits of LoadBook::summed. Includes moving obstacles.
inline std::uint64_t summed_walls(const Scene& scene) {
  std::uint64_t bits = scene.domain.loads ? 63 : 0;
  for (int k = 0; k < int(scene.obstacles.size()) && load_row_of_solid(k) < 64; ++k)
    if (const Obstacle& o = scene.obstacles[std::size_t(k)]; o.loads || o.moves())
      bits |= std::uint64_t(1) << load_row_of_solid(k);
  return bits;
}

struct Plan;

/// Bound on the rounding of a force to whole units, N: one unit of displacement for each
/// contribution of a particle to a wall in an update. A particle contributes after the prediction
/// and, per iteration, by the pushes of walls and levels and by the stop at walls.
double load_grain(const Scene& scene, const Plan& plan);

/// The numbers of the columns of loads (lib/program/column.h) from the loads of all rows.
std::vector<double> load_readings(const std::vector<Load>& loads, const Scene& scene,
                                  const Plan& plan);

}  // namespace pbf::program_module
