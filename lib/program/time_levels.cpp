#include "lib/program/time_levels.h"

#include <algorithm>
#include <cmath>

#include "lib/scene/keys.h"

namespace pbf::program_module {

int finest_level(const Scene& s) {
  if (!s.time.adaptive) return 0;
  const double floor = s.time.adaptive->step_min.value_or(s.time.step / 64);
  return std::max(0, int(std::floor(std::log2(s.time.step / floor) + 1e-9)));
}

Scene scene_at_level(const Scene& scene, int level) {
  Scene s = scene;
  if (level == 0) return s;
  for (const Key& key : scene_table().keys) {
    if (key.at_level == nullptr || !key.block->is_present(object(s))) continue;
    double& value = *std::get<double*>(key.field(object(s)));
    value = key.at_level(value, level);
  }
  return s;
}

}  // namespace pbf::program_module
