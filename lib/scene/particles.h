// The initial particles on the host.
#pragma once

#include <cstddef>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::inline scene_module {

/// Initial particles in id order, SI units.
struct Particles {
  std::vector<Double3> position;            ///< m
  std::vector<Double3> velocity;            ///< m/s
  std::size_t put_on_margin = 0;            ///< that were nearer to a wall than solver.wall_margin
  double farthest_put = 0;                  ///< m, by how much at most
  std::vector<std::size_t> in_obstacles{};  ///< of each body, left out; empty: there are none
  std::vector<SceneFile> files;  ///< that were read, in the order of the bodies, then of motions
  std::size_t size() const { return position.size(); }
};

}  // namespace pbf::inline scene_module
