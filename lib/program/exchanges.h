// What the ranks of a run exchange: copies of their neighbors' rows, rows that move to another
// rank, and sums. All of it follows from the declarations of the passes (needs.h).
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "lib/program/plan.h"

namespace pbf::program_module {

/// Layers of cells along the slowest axis that ranks do not cut apart: with levels those of a
/// brick, 4 cells of 2 x 2 x 2 cells of the search grid.
inline int layers_per_unit(const Plan& plan) { return plan.levels.all.count > 0 ? 8 : 1; }

/// The exchanges for one launch of a pass. A rank makes lists for its own particles. Ghosts are its
/// copies of the particles of other ranks within one cell of them.
struct Exchange {
  using Fields = std::vector<const FieldInfo*>;
  /// Null: no pass, but the mean compression before each round of `until`, one sum over all ranks.
  const PassInfo* pass = nullptr;
  /// Before the launch: the ghosts' rows of these arrays, named as they are after the flips of the
  /// pass. A row is sent as it is in memory, with x, y, z even if only w has changed: the rows at a
  /// cut are contiguous, so nothing is packed.
  Fields ghosts;
  /// Of a pass that sorts, within it: what goes along with a particle to its new rank, and to ranks
  /// that keep it as a ghost until the next sort.
  Fields rows;
  Fields sums;         ///< before the launch: these become their sums over all ranks
  Fields sums_within;  ///< the same between two launches of the pass itself
  /// Before the launch: the pass adds to these, and all ranks have the same in them, so all but one
  /// begin from 0.
  Fields from_zero;
  /// The pass adds to sums but reads no particles, so all ranks would add the same: only one may.
  bool on_one_rank = false;
};

/// Bytes of one row of all these fields.
int row_bytes(const Exchange::Fields& fields, Precision precision);

/// Which copies and sums are current between two passes; at first no copies.
class RankState {
 public:
  /// What the next launch needs; it then counts as launched. Exchanges and passes alternate in the
  /// same way on all ranks. first_iteration: the pass is in the first iteration of a substep or in
  /// none. Throws Error(internal) if a pass adds to a sum that was read but not set anew.
  Exchange before(const PassInfo& pass, bool first_iteration, const Program& program);
  bool operator==(const RankState&) const = default;

 private:
  using Array =
      std::pair<const FieldInfo*, bool>;  ///< of a pair: the field, and whether the second
  std::set<Array> fresh_;                 ///< ghosts are as on the rank of the particle
  std::set<Array> parts_;                 ///< each rank has the sum over its own particles
  std::set<Array> totals_;
};

/// One entry per launch, in order. `until` is the entry of its sum and then its body once: the
/// exchanges of all rounds are the same.
std::vector<Exchange> exchanges(const Program& program, const Steps& steps, RankState& state);
/// The same for an update in the middle of a run: program.next and program.rest.
std::vector<Exchange> exchanges(const Program& program);

/// Whether several ranks run the passes of an update one by one, because rows near solids are
/// predicted in place, and particles go to other ranks only then. With walls alone their sort
/// predicts, and is fused with the pass before it, as on one rank.
bool unfused_on_ranks(const Program& program, const Scene& scene);
/// The exchanges of an update in the middle of a run on several ranks.
std::vector<Exchange> exchanges_on_ranks(const Program& program, const Scene& scene);

}  // namespace pbf::program_module
