#include "lib/program/time_levels.h"

#include <algorithm>
#include <cmath>

namespace pbf::inline program_module {

int finest_level(const Scene& s) {
  if (!s.time.adaptive) return 0;
  const double floor = s.time.adaptive->step_min.value_or(s.time.step / 64);
  return std::max(0, int(std::floor(std::log2(s.time.step / floor) + 1e-9)));
}

Scene scene_at_level(const Scene& scene, int level) {
  Scene s = scene;
  if (level == 0) return s;
  s.time.step = std::ldexp(s.time.step, -level);
  s.solver.velocity_damping = std::pow(s.solver.velocity_damping, std::ldexp(1, -level));
  s.solver.speed_limit = std::ldexp(s.solver.speed_limit, -level);
  if (s.viscosity) s.viscosity->xsph = std::ldexp(s.viscosity->xsph, -level);
  if (s.tensile) s.tensile->k = std::ldexp(s.tensile->k, -2 * level);
  return s;
}

}  // namespace pbf::inline program_module
