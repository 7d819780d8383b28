// Loads on walls in SI units, and the table of their numbers, from which the columns of the log are
// made.
#pragma once

#include <string>
#include <vector>

#include "kernels/boundary/loads.h"
#include "lib/program/plan.h"

namespace pbf::inline solver_module {

/// What the fluid did to a wall or an obstacle in an interval, along the scene's axes. Without time
/// all is 0.
struct WallLoad {
  std::string wall;              ///< "z_min", or the name of an obstacle
  double force[3] = {0, 0, 0};   ///< N, mean
  double torque[3] = {0, 0, 0};  ///< N m, mean, about the middle of it, where that is
  double peak = 0;               ///< N, largest mean force of an update
};

struct LoadNumber {
  const char *name, *unit;
  double (*value)(const WallLoad&);
};
const std::vector<LoadNumber>& load_numbers();

/// Of every wall of a scene with loads, in the order x_min, x_max ...; none where it has none.
std::vector<WallLoad> wall_loads(const std::vector<Load>& loads, const Scene& scene,
                                 const Plan& plan);

}  // namespace pbf::inline solver_module
