#include "lib/program/levels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/smoothing.h"
#include "lib/scene/body_box.h"
#include "lib/scene/surface.h"

namespace pbf::program_module {
namespace {

constexpr double kDeep = 64;  ///< layers; also in a text of why_no_levels()

double lattice_gamma(double ratio, double vol, int dimensions) {
  const int reach = int(std::ceil(ratio)), y_reach = dimensions == 2 ? 0 : reach;
  const double norm =
      dimensions == 2 ? Spiky<double, 2>::gradient_norm : Spiky<double, 3>::gradient_norm;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -y_reach; j <= y_reach; ++j)
      for (int k = -reach; k <= reach; ++k) {
        const double q = std::sqrt(double(i * i + j * j + k * k)) / ratio;
        if (q > 0 && q < 1) sum += (1 - q) * (1 - q) * q;
      }
  return std::fabs(vol * norm * sum / dimensions);
}

}  // namespace

double fluid_layers(const Scene& s, const BodyBox& of_files) {
  BodyBox all = of_files;
  for (const Body& b : s.bodies)
    if (!b.from_file()) all.add(body_box(b));
  double deepest = length(s.gravity) == 0 ? std::numeric_limits<double>::infinity() : 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (s.gravity[k] != 0)
      deepest = std::max(deepest, (all.high[k] - all.low[k]) / s.fluid.spacing);
  return deepest;
}

const char* why_no_levels(const Scene& s) {
  if (s.solver.iterations == 0) return "solver.iterations is 0";
  if (s.solver.levels == LevelsMode::off) return "solver.levels is off";
  if (!s.domain.periodic.empty()) return "the scene has periodic axes (domain.periodic)";
  if (!s.emitters.empty()) return "the scene has emitters";
  if (has_pressure_on_wall(s)) return "the scene has a pressure gauge on a wall";
  if (s.solver.levels == LevelsMode::automatic &&
      !(length(s.gravity) > 0 && fluid_layers(s) >= kDeep))
    return "solver.levels is auto, the fluid less than 64 layers deep";
  return nullptr;
}

LevelPlan plan_levels(const Scene& s, double cell_edge, double vol, double layers) {
  LevelPlan plan;
  const double ratio = s.fluid.smoothing_ratio, edge = 2 * cell_edge;
  LevelShape level;
  plan.grid.edge = edge;
  plan.grid.half_full = 0.5 * std::pow(edge * ratio, s.dimensions);
  for (std::size_t k = 0; k < 3; ++k) {
    if (s.dimensions == 2 && k == 1) continue;
    const double box = (s.domain.max[k] - s.domain.min[k]) / s.h();
    plan.grid.cells[k] = std::max(1, int(std::lround(box / edge)));
    plan.grid.last[k] = box - edge * (plan.grid.cells[k] - 1);
    plan.grid.share[k] = plan.grid.last[k] / edge;
    level.nodes[k] = plan.grid.cells[k] + 1;
  }
  for (;;) {
    plan.all.level[plan.all.count++] = level;
    const bool fits = (2 << plan.all.count) * (edge * ratio) <= layers;
    if (*std::max_element(level.nodes, level.nodes + 3) <= 2 || !fits) break;
    level.first += level.size();
    for (int k = 0; k < 3; ++k) {
      const int intervals = level.nodes[k] - 1;
      level.nodes[k] = intervals > 1 ? (intervals + 1) / 2 + 1 : 1;
    }
  }
  plan.gamma = lattice_gamma(ratio, vol, s.dimensions);
  return plan;
}

}  // namespace pbf::program_module
