#include "lib/program/rank_plan.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lib/base/json.h"
#include "lib/base/text.h"
#include "lib/program/exchanges.h"

namespace pbf::program_module {

namespace {

/// What is on rank 0 alone: pieces of what all ranks have, at times that follow each other, and
/// what does not come in pieces.
std::int64_t bytes_of_first(const Plan& plan, const Scene& s) {
  // Of the start, of checkpoints, of a dataset.
  const std::int64_t n = plan.particles, few = std::min(n, std::int64_t{1} << 16),
                     piece = std::min(n, std::int64_t{1} << 18),
                     chunk = std::min(n, std::int64_t{1} << 22);
  std::int64_t start = 200 * few, output = s.checkpoint ? 160 * piece : 0;
  for (const Body& b : s.bodies)
    if (b.from_file()) start = 48 * n + 200 * few;
  if (s.output) output = std::max(output, 16 * chunk);  // numbers of vertices
  if (s.output && s.output->compression == Compression::gzip)
    output = std::max(output,
                      8 * 3 * std::int64_t(s.output->precision == Precision::dbl ? 8 : 4) * chunk);
  std::int64_t pictures = 0;
  if (s.render)
    for (const PlanArray& a : plan.memory.arrays)
      if (!a.on_device && a.held == Held::output) pictures += a.bytes;
  return std::max(start, std::max(output, pictures));
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
  // Ranks may differ by 4 %, and have ghosts on two sides. When cuts move, 4 % or a unit of layers
  // come over each (Slabs::balance()).
  const double share = double(plan.particles) / ranks;
  const auto rows = [&](double part, int faces) {
    return std::min(std::int64_t(part * share) + faces * r.ghosts, 2 * plan.particles);
  };
  const bool on_device = about(s.backend).on_device;
  Plan part = plan;
  part.capacity =
      on_device ? rows(1.04 + 0.04 * std::min(ranks - 1, 2), 6 + 2 * layers_per_unit(plan)) + 4096
                : std::min(rows(1.05, 2), plan.particles);
  // On the host an array takes memory as its pages are written. On a device there must be room for
  // unequal shares, and for rows that come before others go.
  r.capacity = on_device ? part.capacity : 2 * plan.particles;
  Scene of_rank = s;
  of_rank.render.reset();
  const MemoryPlan memory = plan_memory_of_rank(of_rank, part);
  r.bytes = memory.host_peak();
  r.first_bytes = r.bytes + bytes_of_first(plan, s);
  r.device_bytes = on_device ? memory.device_peak() : 0;
  return r;
}

Scene scene_of_rank(const Plan& whole, Scene scene, int ranks) {
  scene.capacity = plan_ranks(whole, scene, ranks).capacity;
  return scene;
}
Plan plan_of_rank(const Plan& whole, const Scene& of_rank) {
  Plan plan = make_plan(of_rank, whole.particles, whole.start);
  plan.capacity = of_rank.capacity;  // fewer than all particles
  plan.turns = whole.turns;          // the bits of all ranks together are those of one
  plan.packed = whole.packed;
  plan.program = make_program(of_rank, plan.shape());
  plan.memory = plan_memory_of_rank(of_rank, plan);
  return plan;
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
             "  {} of memory on the host for each rank; {} on rank 0, through which pieces of all "
             "particles go\n",
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
