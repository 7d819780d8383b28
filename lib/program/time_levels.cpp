#include "lib/program/time_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/scene/keys.h"

namespace pbf::program_module {

int finest_level(const Scene& s) {
  if (!s.time.adaptive) return 0;
  const double floor = s.time.adaptive->step_min.value_or(s.time.step / 64);
  return std::max(0, int(std::floor(std::log2(s.time.step / floor) + 1e-9)));
}

double longest_step(const Scene& s, double speed, double acceleration) {
  const double none = std::numeric_limits<double>::infinity(), h = s.h();
  const AdaptiveTime& a = *s.time.adaptive;
  return std::min(speed > 0 ? a.cfl * h / speed : none,
                  acceleration > 0 ? a.force * std::sqrt(h / acceleration) : none);
}

int next_level(const Scene& s, int level, double longest, bool may_coarsen) {
  const int finest = finest_level(s);
  int k = level;
  while (k < finest && std::ldexp(s.time.step, -k) > longest) ++k;
  const double coarser = std::ldexp(s.time.step, 1 - k);
  return k == level && k > 0 && may_coarsen && 2 * coarser <= longest ? k - 1 : k;
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
