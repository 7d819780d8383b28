// Positions and rotations of moving obstacles, for readers of a run.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

struct ObstaclePose {
  std::string name;
  Double3 middle{};               ///< m: present position of the body's middle
  std::array<Double3, 3> turn{};  ///< rows of the rotation from the pose in the scene file
};

/// Poses of the moving obstacles, `time` s after the start.
std::vector<ObstaclePose> obstacle_poses(const Scene& scene, double time);

}  // namespace pbf::inline program_module
