// What several ranks of a run would send to each other.
#pragma once

#include <cstdint>
#include <string>

#include "lib/base/json.h"
#include "lib/program/plan.h"

namespace pbf::program_module {

struct RankPlan {
  int ranks = 1;
  int layers = 1;     ///< of cells along the longest edge, in units that are not cut
  int exchanges = 0;  ///< of ghosts, per update and adjacent rank: a message each
  int sorts = 0;      ///< per update and adjacent rank: a message each, of rows
  /// Bytes of a ghost in all messages of an update, its row in the sorts included.
  std::int64_t bytes_per_ghost = 0;
  /// Of a rank on one side, in fluid at rest that fills the cross-section.
  std::int64_t ghosts = 0;
  std::int64_t capacity = 0;  ///< rows of the arrays of a rank
  /// Peak memory of a rank on the host, and of rank 0, through which pieces of all particles go,
  /// and which has all of them for pictures and of bodies from files; and of a rank on its device.
  std::int64_t bytes = 0, first_bytes = 0, device_bytes = 0;

  int messages() const { return exchanges + sorts; }
};

/// Without solver.tolerance, which repeats exchanges, and without the passes between updates.
RankPlan plan_ranks(const Plan& plan, const Scene& scene, int ranks);
/// plan_memory() of one of several ranks. plan: with the rows of the rank.
MemoryPlan plan_memory_of_rank(const Scene& scene, const Plan& plan);
/// The scene by which each of several ranks makes its solver. Its capacity is that of a rank, so
/// that passes know the own rows as rows of a number that changes.
Scene scene_of_rank(const Plan& whole, Scene scene, int ranks);
/// The plan for it: of all particles, with memory for the rows of a rank.
Plan plan_of_rank(const Plan& whole, const Scene& of_rank);
std::string rank_text(const RankPlan& plan);
Json rank_json(const RankPlan& plan);

}  // namespace pbf::program_module
