#include "lib/program/substep_lists.h"

#include <algorithm>
#include <cmath>

#include "lib/program/motion.h"
#include "lib/scene/nozzle.h"

namespace pbf::program_module {
namespace {

/// Limit of n (u n dt)/h; below 10 no run gained energy (kernels/README.md, "Substeps").
constexpr double kMotionOnOneList = 8;

/// Substeps on one list if velocities come from a file. 8 gained no energy with motions of 0.9 h.
constexpr double kSubstepsOfUnknown = 8;

}  // namespace

double fall_speed(const Scene& s) {
  double squared = 0, g = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    squared += 2 * std::fabs(s.gravity[a]) * (s.domain.max[a] - s.domain.min[a]);
    g += s.gravity[a] * s.gravity[a];
  }
  return std::sqrt(squared) + (s.domain.open.empty() ? 0 : std::sqrt(g) * s.time.end);
}

double way_per_update(const Scene& s) {
  double fastest = 0;
  for (const Body& b : s.bodies)
    fastest = std::max(fastest, std::hypot(b.velocity[0], b.velocity[1], b.velocity[2]));
  fastest = std::max(fastest, fastest_emitter(s, 0, s.time.end));
  if (has_moving_obstacles(s)) fastest = std::max(fastest, fastest_obstacle(s, 0, s.time.end));
  return (fall_speed(s) + fastest) * s.time.step / s.h();
}

int lists_per_update(const Scene& s) {
  const int substeps = s.solver.substeps;
  if (substeps == 1) return 1;
  const double way = way_per_update(s);
  // With k lists: (substeps/k) (way/k) <= kMotionOnOneList.
  const double lists = std::ceil(std::sqrt(substeps * way / kMotionOnOneList));
  // The velocities of particles from files are not known here.
  const bool unknown = std::any_of(s.bodies.begin(), s.bodies.end(),
                                   [](const Body& b) { return b.shape == Shape::file; });
  const double least = unknown ? std::ceil(substeps / kSubstepsOfUnknown) : 1.0;
  return int(std::clamp(lists, least, double(substeps)));
}

}  // namespace pbf::program_module
