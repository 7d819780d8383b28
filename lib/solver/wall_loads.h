// Loads on walls in SI units, and the table of their numbers, which defines their columns in the
// log.
#pragma once

#include <string>
#include <vector>

#include "kernels/boundary/loads.h"
#include "lib/program/plan.h"

namespace pbf::inline solver_module {

/// Forces of the fluid on a wall or an obstacle in an interval, along the scene's axes. All 0 for
/// an interval of length 0.
struct WallLoad {
  std::string wall;              ///< "z_min", or the name of an obstacle
  double force[3] = {0, 0, 0};   ///< N, mean
  double torque[3] = {0, 0, 0};  ///< N m, mean, about its present middle
  double peak = 0;               ///< N, largest mean force of an update
};

struct LoadNumber {
  const char *name, *unit;
  double (*value)(const WallLoad&);
};
const std::vector<LoadNumber>& load_numbers();

/// Loads of the walls in the order x_min, x_max ..., then of obstacles; empty without loads.
std::vector<WallLoad> wall_loads(const std::vector<Load>& loads, const Scene& scene,
                                 const Plan& plan);

}  // namespace pbf::inline solver_module
