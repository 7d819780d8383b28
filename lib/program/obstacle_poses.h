// Positions and rotations of moving obstacles, for readers of a run.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

struct ObstaclePose {
  std::string name;
  Double3 middle{};               ///< m: of the body, which the scene's keys put elsewhere
  std::array<Double3, 3> turn{};  ///< rows of the rotation since then
};

/// Of those that move, `time` s after the start.
std::vector<ObstaclePose> obstacle_poses(const Scene& scene, double time);

}  // namespace pbf::inline program_module
