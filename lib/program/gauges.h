// The gauges of a scene in the form that the kernels use.
#pragma once

#include <vector>

#include "kernels/axes.h"
#include "kernels/boundary/loads.h"
#include "kernels/boundary/obstacle.h"
#include "kernels/boundary/patch.h"
#include "kernels/gauge_probe.h"
#include "kernels/pass_flow.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// The interval between two sample points of a level gauge.
struct LevelPiece {
  double from = 0, to = 1;  ///< the part of it outside of obstacles, as fractions
};

/// Where fluid can be along a level gauge (lib/solver/gauge_readings.h).
struct LevelLine {
  std::vector<double> room;        ///< at each point, the share of the kernel outside of solids
  std::vector<LevelPiece> pieces;  ///< between the points
};

/// Each list in the order of its gauges in the scene.
struct GaugePlan {
  std::vector<Probe> probes;     ///< of level and velocity gauges
  std::vector<LevelLine> lines;  ///< of level gauges
  std::vector<FlowGate> gates;
  std::vector<Patch> patches;
  std::vector<double> areas;  ///< m^2, integral of patch_share() over the surface of each patch
  int places = 0;             ///< sample points of all probes
  double weight = 0;          ///< ProbeSums::weight times this is the volume fraction of fluid
};

/// Sums of one reading, in the order of the scene's gauges.
struct GaugeSums {
  std::vector<ProbeSums> places;
  std::vector<FlowCount> flows;
  std::vector<Load> patches;
};

/// `solids`: Plan::solids; `mass`: kg, of one particle.
GaugePlan plan_gauges(const Scene& scene, const Axes& axes,
                      const std::vector<Solid<double>>& solids, double mass);

}  // namespace pbf::inline program_module
