#include "lib/program/relaxation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "lib/program/levels.h"
#include "lib/program/time_order.h"

namespace pbf::program_module {
namespace {

/// The default of omega is min(most, (reach d/h)^power).
struct Rule {
  double reach, most = 1;
};

Rule rule(const Scene& s) {
  const int iterations = s.solver.iterations;
  const bool second = is_second_order(s);
  if (s.dimensions == 2) {
    if (has_levels(s)) return second && iterations == 1 ? Rule{1.85, 0.8} : Rule{2.4};
    if (iterations == 1) return second ? Rule{1.55, 0.75} : Rule{1.7, 0.85};
    if (iterations == 2) return second ? Rule{2.4} : Rule{2.7};
    return second ? Rule{2.7} : Rule{3};
  }
  if (has_levels(s) && iterations > 1) return {2};
  if (has_levels(s) && !second) return {1.9};
  if (iterations == 1) return second ? Rule{1.6, 0.75} : Rule{1.8, 0.85};
  if (iterations == 2) return second ? Rule{1.95} : Rule{2.2};
  if (iterations == 3) return second ? Rule{2.2} : Rule{2.3};
  return second ? Rule{2.3} : Rule{2.5};
}

}  // namespace

double default_sor(const Scene& s) {
  const Rule r = rule(s);
  return std::min(r.most,
                  std::pow(r.reach / s.fluid.smoothing_ratio, s.dimensions == 2 ? 4.0 / 3 : 2.0));
}

double sor_limit(const Scene& s) {
  // Still water bursts from 1.1 times the default on with one or two iterations, and columns throw
  // particles up from 1.25 times on with more.
  return (s.solver.iterations <= 2 ? 1.1 : 1.25) * default_sor(s);
}

std::string sor_text(const Scene& s) {
  if (!s.solver.sor || s.solver.iterations == 0 || !(*s.solver.sor > sor_limit(s))) return "";
  return fmt::format(
      "solver.sor {:.3g} is above {:.3g}, up to which still water stays still with {} iteration{} "
      "in a substep and h = {:.3g} spacings: the fluid may gain energy and burst; leave it out "
      "({:.3g}){}",
      *s.solver.sor, sor_limit(s), s.solver.iterations, s.solver.iterations == 1 ? "" : "s",
      s.fluid.smoothing_ratio, default_sor(s),
      s.solver.iterations <= 2 ? ", or give 4 iterations" : "");
}

}  // namespace pbf::program_module
