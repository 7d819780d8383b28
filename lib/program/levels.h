// The grids of solver.levels: whether a scene has them, and their shape (kernels/levels.h).
#pragma once

#include "kernels/levels.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

struct LevelPlan {
  LevelCells grid;
  LevelHierarchy all;  ///< none: no levels
  /// Share of the squared edge of a level's cells by which it answers to the mean C around a node.
  double beta = 0.25;
  /// -grad k -> displacement: what the sum over pairs makes of a multiplier with that gradient on
  /// the rest lattice, vol sum |grad W| q / D.
  double gamma = 0;

  std::int64_t nodes() const {
    if (all.count == 0) return 0;
    const LevelShape& last = all.level[all.count - 1];
    return last.first + last.size();
  }
  std::int64_t cells() const { return all.count == 0 ? 0 : grid.size(); }
  /// Of particles, in a scene of so many dimensions.
  std::int64_t runs(int dimensions) const { return all.count == 0 ? 0 : grid.runs(dimensions); }
  std::int64_t bricks() const { return all.count == 0 ? 0 : grid.bricks(); }
};

/// Why a scene has none, "solver.levels is off"; null where it has. With `auto` it has them from 64
/// layers of fluid along gravity on.
const char* why_no_levels(const Scene& scene);
inline bool has_levels(const Scene& scene) { return why_no_levels(scene) == nullptr; }

/// cell_edge: h, of the search grid's cells. The scene is in internal axes.
LevelPlan plan_levels(const Scene& scene, double cell_edge, double vol);

}  // namespace pbf::inline program_module
