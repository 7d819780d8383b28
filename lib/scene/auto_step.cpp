#include "lib/scene/auto_step.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/scene/nozzle.h"
#include "lib/scene/number.h"

namespace pbf::scene_module {
namespace {

/// Truncates to two digits: 0.00428 becomes 0.0042.
double two_digits(double x) {
  const std::string text = fmt::format("{:.15e}", x);
  double cut = x;
  read_number(text.substr(0, 3) + text.substr(text.find('e')), cut);
  return cut;
}

double magnitude(const Double3& v) { return std::hypot(v[0], v[1], v[2]); }

}  // namespace

double relative_step(const Scene& s) {
  return s.time.step * std::sqrt(magnitude(s.gravity) / s.h());
}

StepRule step_rule(const Scene& s) {
  constexpr double never = std::numeric_limits<double>::infinity();
  double fastest = 0;
  for (const Body& b : s.bodies) fastest = std::max(fastest, magnitude(b.velocity));
  fastest = std::max(fastest, fastest_emitter(s, 0, s.time.end));
  const double g = magnitude(s.gravity);
  return {g > 0 ? kSafeStep * std::sqrt(s.h() / g) : never,
          fastest > 0 ? kSafeWay * s.h() / fastest : never};
}

double fitted_step(const Scene& s, double longest) {
  if (!std::isfinite(longest)) return 0;
  if (!s.output) return two_digits(longest);
  // A ratio that is whole up to rounding counts as whole.
  return s.output->every / std::ceil(s.output->every / longest * (1 - 1e-9));
}

double auto_step(const Scene& s) { return fitted_step(s, step_rule(s).longest()); }

}  // namespace pbf::scene_module
