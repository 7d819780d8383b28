// How crowded a start is, before its particles are made.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf {

/// Of a sample of the scene's particles, spread evenly over their ids.
struct StartNeighbors {
  std::vector<int> count;       ///< particles within h, the particle itself included
  std::vector<double> scatter;  ///< standard deviation of the counts around it; 0: too few sampled
  bool empty() const { return count.empty(); }
};

/// Empty where no place can be denser than fluid at rest: blocks and spheres that do not overlap.
/// Takes time in proportion to `particles`, of count_particles(), and memory for the sample alone,
/// but for the particles of file bodies, which are read. The same sample for the same scene. Throws
/// as emit_particles() does for a file that cannot be read; places outside the domain are no error
/// here.
StartNeighbors start_neighbors(const Scene& scene, const std::string& scene_dir,
                               std::int64_t particles);

}  // namespace pbf
