#include "lib/program/rank_plan.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "lib/base/json.h"
#include "lib/base/text.h"
#include "lib/program/exchanges.h"

namespace pbf::program_module {

namespace {

/// What is on rank 0 alone: arrays of all particles, at times that follow each other.
std::int64_t bytes_of_all(const MemoryPlan& memory) {
  std::map<Held, std::int64_t> sums;
  for (const PlanArray& a : memory.arrays)
    if (!a.on_device && a.held != Held::solver && !a.name.starts_with("initial "))
      sums[a.held] += a.bytes;
  std::int64_t most = 0;
  for (const auto& [held, bytes] : sums) most = std::max(most, bytes);
  return most;
}

}  // namespace

RankPlan plan_ranks(const Plan& plan, const Scene& s, int ranks) {
  RankPlan r;
  r.ranks = ranks;
  r.layers = (plan.cells[2] + layers_per_unit(plan) - 1) / layers_per_unit(plan);
  for (const Exchange& e : exchanges_on_ranks(plan.program, s)) {
    r.exchanges += !e.ghosts.empty();
    r.sorts += !e.rows.empty();
    r.bytes_per_ghost += row_bytes(e.ghosts, s.precision) + row_bytes(e.rows, s.precision);
  }
  // Cells along x are halves.
  const double wide = plan.cells[0] / 2.0 * plan.cell_edge,
               deep = s.dimensions == 2 ? 1 : plan.cells[1] * plan.cell_edge;
  r.ghosts = std::int64_t(
      std::ceil(wide * deep * plan.cell_edge * std::pow(s.fluid.smoothing_ratio, s.dimensions)));
  // Ranks may differ by 5 %, and have ghosts on two sides.
  const double share = double(plan.particles) / ranks;
  const auto rows = [&](double part, int faces) {
    return std::min(std::int64_t(part * share) + faces * r.ghosts, 2 * plan.particles);
  };
  const bool on_device = about(s.backend).on_device;
  Plan part = plan;
  part.capacity = on_device ? rows(1.15, 6) + 4096 : std::min(rows(1.05, 2), plan.particles);
  // On the host an array takes memory as its pages are written. On a device there must be room for
  // unequal shares, and for rows that come before others go.
  r.capacity = on_device ? part.capacity : 2 * plan.particles;
  Scene of_rank = s;
  of_rank.output.reset(), of_rank.render.reset(), of_rank.checkpoint.reset();
  const MemoryPlan memory = plan_memory(of_rank, part);
  r.bytes = memory.host_peak();
  r.first_bytes = r.bytes + bytes_of_all(plan.memory);
  r.device_bytes = on_device ? memory.device_peak() : 0;
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
             "ghosts\n"
             "  {} of memory on the host for each rank; {} on rank 0, which has all particles at "
             "the start and in frames\n",
             r.messages(), r.sorts, r.exchanges, r.bytes_per_ghost,
             bytes_text(double(r.bytes_per_ghost * r.ghosts)), r.ghosts,
             bytes_text(double(r.bytes)), bytes_text(double(r.first_bytes))) +
         (r.device_bytes > 0
              ? fmt::format("  {} on the device of each rank\n", bytes_text(double(r.device_bytes)))
              : std::string());
}

Json rank_json(const RankPlan& r) {
  return {{"ranks", r.ranks},
          {"most_ranks", r.layers},
          {"messages_per_update", r.messages()},
          {"bytes_per_ghost", r.bytes_per_ghost},
          {"ghosts", r.ghosts},
          {"host_peak", r.bytes},
          {"host_peak_of_rank_0", r.first_bytes},
          {"device_peak", r.device_bytes}};
}

}  // namespace pbf::program_module
