// The grids of solver.levels: whether a scene uses them, and their shape (kernels/levels.h).
#pragma once

#include "kernels/levels.h"
#include "lib/scene/body_box.h"

namespace pbf::program_module {

struct LevelPlan {
  LevelCells grid;
  LevelHierarchy all;  ///< empty without levels
  /// Multiplier of a node: beta s^2 times the mean C around it, s: edge of the cells of its level.
  double beta = 0.25;
  /// Displacement by -grad k, the multiplier's gradient. The pair sum gives the same displacement
  /// on the rest lattice: vol sum |grad W| q / D.
  double gamma = 0;

  std::int64_t nodes() const {
    if (all.count == 0) return 0;
    const LevelShape& last = all.level[all.count - 1];
    return last.first + last.size();
  }
  std::int64_t cells() const { return all.count == 0 ? 0 : grid.size(); }
  /// Number of runs of particles (LevelCells::runs()).
  std::int64_t runs(int dimensions) const { return all.count == 0 ? 0 : grid.runs(dimensions); }
  std::int64_t bricks() const { return all.count == 0 ? 0 : grid.bricks(); }
};

/// Why a scene uses no levels ("solver.levels is off"); null if it uses them. `auto` uses them if
/// the fluid has at least 64 layers along gravity.
const char* why_no_levels(const Scene& scene);
inline bool has_levels(const Scene& scene) { return why_no_levels(scene) == nullptr; }

/// Depth of the common box of bodies and `of_files` along gravity, in layers; without gravity
/// infinity.
double fluid_layers(const Scene& scene, const BodyBox& of_files = kNoBox);

/// cell_edge: edge of the search grid's cells, in h. The scene is in internal axes. The coarsest
/// level fits twice into the depth of the fluid (layers, at the start): coarser ones would have
/// nodes on the floor alone, which take the energy out of waves (kernels/README.md, "Levels").
LevelPlan plan_levels(const Scene& scene, double cell_edge, double vol, double layers);

}  // namespace pbf::program_module
