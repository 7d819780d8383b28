#include "lib/program/rank_plan.h"

#include <fmt/core.h>
#include <cmath>

#include "lib/base/text.h"
#include "lib/program/exchanges.h"

namespace pbf::program_module {

RankPlan plan_ranks(const Plan& plan, const Scene& s, int ranks) {
  RankPlan r;
  r.ranks = ranks;
  r.layers = (plan.cells[2] + layers_per_unit(plan) - 1) / layers_per_unit(plan);
  RankState state;
  exchanges(plan.program, plan.program.update, state);  // the update before
  for (const Exchange& e : exchanges(plan.program, plan.program.update, state)) {
    r.exchanges += !e.ghosts.empty();
    r.sorts += !e.rows.empty();
    r.bytes_per_ghost += row_bytes(e.ghosts, s.precision) + row_bytes(e.rows, s.precision);
  }
  // Cells along x are halves.
  const double wide = plan.cells[0] / 2.0 * plan.cell_edge,
               deep = s.dimensions == 2 ? 1 : plan.cells[1] * plan.cell_edge;
  r.ghosts = std::int64_t(
      std::ceil(wide * deep * plan.cell_edge * std::pow(s.fluid.smoothing_ratio, s.dimensions)));
  return r;
}

std::string rank_text(const RankPlan& r) {
  std::string out = fmt::format(
      "ranks\n  {} slabs of the {} layers of cells across the longest edge\n", r.ranks, r.layers);
  if (r.ranks > r.layers) out += fmt::format("  too many: at most {} ranks\n", r.layers);
  return out +
         fmt::format(
             "  {} messages to each adjacent rank per update: {} of rows at sorts, {} of ghosts\n"
             "  {} bytes per ghost and update; {} across a box full of fluid, from up to {} "
             "ghosts\n",
             r.messages(), r.sorts, r.exchanges, r.bytes_per_ghost,
             bytes_text(double(r.bytes_per_ghost * r.ghosts)), r.ghosts);
}

}  // namespace pbf::program_module
