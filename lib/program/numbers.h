// Dimensionless numbers of a scene, for the plan.
#pragma once

#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::program_module {

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
