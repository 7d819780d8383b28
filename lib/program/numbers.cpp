#include "lib/program/numbers.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "lib/program/motion.h"
#include "lib/program/start_level.h"
#include "lib/scene/auto_step.h"
#include "lib/scene/body_box.h"
#include "lib/scene/surface.h"
#include "lib/scene/viscosity.h"
#include "lib/scene/waves.h"

namespace pbf::program_module {
namespace {

constexpr double kTension = 0.072;  // N/m, of water

/// What the numbers are made of, SI units.
struct FlowSizes {
  double depth = 0;  ///< m, of the highest body of fluid
  double tank = 0;   ///< m, longest level edge of the domain
  double width = 0;  ///< m, least extent of an obstacle that is a box; 0: none
  double speed = 0;  ///< m/s, U of scene_numbers()
};

FlowSizes flow_sizes(const Scene& s) {
  FlowSizes z;
  const auto down = std::size_t(level_axis(s));
  for (const int a : axes_across_level(s)) {
    const double edge = s.domain.max[std::size_t(a)] - s.domain.min[std::size_t(a)];
    z.tank = std::max(z.tank, edge);
  }
  for (const Body& b : s.bodies) {
    if (b.from_file()) continue;
    const BodyBox box = body_box(b);
    z.depth = std::max(z.depth, box.high[down] - box.low[down]);
    z.speed = std::max(z.speed, length(b.velocity));
  }
  const double g = length(s.gravity);
  const StartLevel level = g > 0 ? start_level(s) : StartLevel{};
  const double fall = level.rests ? 0 : level.top - level.rest;
  if (fall > s.fluid.spacing) z.speed = std::max(z.speed, std::sqrt(g * fall));
  z.speed = std::max(z.speed, fastest_obstacle(s, 0, s.time.end));
  for (const Obstacle& o : s.obstacles) {
    if (const auto* box = std::get_if<obstacle_keys::Box>(&o.shape)) {
      const Double3 edge = box->max - box->min;
      const double least = s.plane() ? std::min(edge[0], edge[2]) : std::ranges::min(edge);
      z.width = z.width > 0 ? std::min(z.width, least) : least;
    }
    if (!o.motion || !makes_waves(*o.motion)) continue;
    const WaveMaker w = wave_maker(s, o);
    z.depth = w.depth;
    z.speed = std::max(z.speed, w.solitary.empty() ? 3.14159265358979323846 * w.height / w.period /
                                                         std::tanh(w.kd())
                                                   : w.speed * w.height / (w.depth + w.height));
  }
  return z;
}

}  // namespace

std::vector<SceneNumber> scene_numbers(const Scene& s) {
  const FlowSizes z = flow_sizes(s);
  const double d = s.fluid.spacing, h = s.h(), g = length(s.gravity), rho = s.fluid.rest_density,
               dt = s.time.step / s.solver.substeps;
  std::vector<SceneNumber> all;
  const auto add = [&](const char* name, const char* formula, double value,
                       const std::string& note = "") {
    if (std::isfinite(value) && value > 0) all.push_back({name, formula, value, note});
  };
  add("D/d", "depth over spacing", z.depth / d);
  add("L_tank/d", "longest level edge of the domain over spacing", z.tank / d);
  if (z.width > 0)
    add("width/d", "least edge of the obstacles that are boxes over spacing", z.width / d,
        z.width < 4 * d ? "thin: below 4" : "");
  for (const Obstacle& o : s.obstacles) {
    if (!o.motion || !makes_waves(*o.motion)) continue;
    const WaveMaker w = wave_maker(s, o);
    add("H/d", "height of waves over spacing", w.height / d);
    add("L/d", "length of waves over spacing", w.length() / d);
    add("H L^2/D^3", "Ursell", w.ursell());
  }
  add("dt sqrt(g/h)", "step of gravity, dt of a substep", dt * std::sqrt(g / h));
  const double c = std::sqrt(g * z.depth);
  add("c dt/h", "way of a long wave in a substep, c = sqrt(g D)", c * dt / h);
  add("U dt/h", "way of the flow in a substep", z.speed * dt / h);
  add("Fr", "U/c", z.speed / c);
  const double own = kOwnViscosity * z.speed * d, nu = own + kinematic_viscosity(s);
  add("Re", "U D/nu, nu = 0.2 U d and that of the scene", z.speed * z.depth / nu,
      fmt::format("numerical, at most 5 D/d = {:.3g}", 5 * z.depth / d));
  // 10 capillary lengths make Bo 100.
  const auto tension = [](double value, double least) {
    return value < least ? fmt::format(
                               "below {:g} surface tension matters in water of this size; "
                               "it is not simulated",
                               least)
                         : "";
  };
  const double weber = rho * z.speed * z.speed * z.depth / kTension,
               bond = rho * g * z.depth * z.depth / kTension;
  add("We", "rho U^2 D/sigma of water", weber, tension(weber, 10));
  add("Bo", "rho g D^2/sigma of water", bond, tension(bond, 100));
  return all;
}

std::string numbers_part(const Scene& s) {
  std::string out;
  for (const SceneNumber& n : scene_numbers(s))
    out += fmt::format("  {:13} {:9.3g}  {}{}\n", n.name, n.value, n.formula,
                       n.note.empty() ? "" : "; " + n.note);
  return out.empty() ? out : "numbers\n" + out;
}

}  // namespace pbf::program_module
