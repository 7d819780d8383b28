// The gauges of a scene in the form that the kernels use.
#pragma once

#include <vector>

#include "kernels/axes.h"
#include "kernels/boundary/obstacle.h"
#include "kernels/boundary/patch.h"
#include "kernels/gauge_probe.h"
#include "kernels/pass_flow.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// Between two places of a level gauge.
struct LevelPiece {
  double from = 0, to = 1;  ///< the part of it that is in no obstacle
};

/// What says how much of the line is wet (lib/solver/gauge_readings.h).
struct LevelLine {
  std::vector<double> room;  ///< at each place, the share of the kernel in walls and obstacles
                             ///< taken from 1
  std::vector<LevelPiece> pieces;  ///< one less
};

/// Each list in the order of its gauges in the scene.
struct GaugePlan {
  std::vector<Probe> probes;     ///< of level and velocity
  std::vector<LevelLine> lines;  ///< of levels
  std::vector<FlowGate> gates;
  std::vector<Patch> patches;
  std::vector<double> areas;  ///< m^2, of each patch what lies on the surface, by patch_share()
  int places = 0;             ///< of all probes
  double weight = 0;          ///< what makes of ProbeSums::weight the share of space that is fluid
};

/// `solids`: Plan::solids; `mass`: of a particle, kg.
GaugePlan plan_gauges(const Scene& scene, const Axes& axes,
                      const std::vector<Solid<double>>& solids, double mass);

}  // namespace pbf::inline program_module
