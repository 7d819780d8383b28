#include "lib/scene/auto_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pbf::inline scene_module {

StepRule step_rule(const Scene& s) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto length = [](const Double3& v) { return std::hypot(v[0], v[1], v[2]); };
  double fastest = 0;
  for (const Body& b : s.bodies) fastest = std::max(fastest, length(b.velocity));
  const double g = length(s.gravity);
  return {g > 0 ? kSafeStep * std::sqrt(s.h() / g) : never,
          fastest > 0 ? kSafeWay * s.h() / fastest : never};
}

double auto_step(const Scene& s) {
  const double longest = step_rule(s).longest();
  if (!std::isfinite(longest)) return 0;
  const double every = s.output ? std::min(s.output->every, s.time.end) : s.time.end;
  // A whole number but for rounding is one.
  return every / std::ceil(every / longest * (1 - 1e-9));
}

}  // namespace pbf::inline scene_module
