// Dimensionless numbers of a scene, for the plan.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// What the numbers are made of, SI units.
struct FlowSizes {
  double depth = 0;  ///< m, of the highest body of fluid
  double tank = 0;   ///< m, longest level edge of the domain
  double width = 0;  ///< m, least extent of an obstacle that is a box; 0: none
  double fall = 0;   ///< m, of the highest body to the level at rest
  double speed = 0;  ///< m/s, U of scene_numbers()
};
FlowSizes flow_sizes(const Scene& scene);

struct SceneNumber {
  std::string name;     ///< "D/d"
  std::string formula;  ///< what it is made of
  double value;
  std::string note;  ///< what the value means; may be empty
};

/// Those that apply. D: height of the highest body of fluid; L_tank: longest level edge of the
/// domain; U: the greater of the speed of a wave's water, of moving parts, and of the fall of the
/// highest body to the level at rest; c = sqrt(g D).
std::vector<SceneNumber> scene_numbers(const Scene& scene);
/// "numbers" and a line each.
std::string numbers_part(const Scene& scene);

}  // namespace pbf::program_module
