// The state of a run on several ranks: in parts and in pieces. Plans and scenes are those of a
// rank.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lib/exec/ranks/slabs.h"
#include "lib/program/plan.h"
#include "lib/scene/particles.h"
#include "lib/solver/solver.h"
#include "lib/solver/solver_state.h"

namespace pbf::exec_module {

/// Rows of particles that are sent, read or written at a time.
inline constexpr std::int64_t kPieceRows = std::int64_t{1} << 18;

std::vector<char> packed(const SolverState& state);
SolverState state_of(const std::vector<char>& packed);

/// A state without the rows of particles.
SolverState head_of(const SolverState& state, const Plan& plan);
/// The heads of all ranks as that of the whole, with the bits that a solver alone would return;
/// only what took energy is not spread over the sums of each cause (kernels/dissipation.h), of
/// which the first holds all.
class WholeHead {
 public:
  WholeHead(const Scene& scene, const Plan& plan) : scene_(scene), plan_(plan) {}
  /// The first is that of rank 0.
  void add(const SolverState& head);
  SolverState result() &&;

 private:
  const Scene& scene_;
  const Plan& plan_;
  SolverState all_{};
  bool empty_ = true;
};
/// The inverse: what a rank gets of a head, with the numbers of rows.
SolverState head_of_rank(const SolverState& head, const Scene& scene, const Plan& plan, int rank,
                         std::int64_t own);

/// The rows with ids from `first` to `last` - 1 of a state that is in the order of ids.
SolverState rows_between(const SolverState& state, std::int64_t first, std::int64_t last,
                         const Plan& plan);
/// Of those that rows_between() has returned on all ranks: `piece` has the rows from `first` on.
void place_rows(const SolverState& rows, std::int64_t first, SolverState& piece);
/// `rows` rows from `first` on, without their values, of the particles whose other parts are
/// `head`.
SolverState piece_of(const SolverState& head, StateOf which, std::int64_t first, std::int64_t rows,
                     const Plan& plan);
/// These rows, and the fields of particles that they have.
SolverState picked(const SolverState& state, const std::vector<int>& rows, const Plan& plan);
/// Appends rows of the same fields of particles.
void append(const SolverState& rows, SolverState& to);

/// The rank with which each particle begins: that which has its layer, as nearly as this can be
/// said before positions have the solver's precision. The first sort moves the others.
class FirstRanks {
 public:
  FirstRanks(const Scene& scene, const Plan& plan, int ranks);
  void count(const SolverState& rows);
  void count(const Particles& rows);
  /// After all have been counted. Throws Error(bad_input) as Slabs.
  void cut();
  std::int64_t particles(int rank) const;
  /// For each rank, which of these rows it gets.
  std::vector<std::vector<int>> rows_of_ranks(const SolverState& rows) const;
  std::vector<std::vector<int>> rows_of_ranks(const Particles& rows) const;

 private:
  /// at: m, or in h from the origin.
  int layer(double at, bool in_h) const;
  const std::size_t axis_;
  const double origin_, h_, cell_;
  const int ranks_, unit_;
  std::vector<std::int64_t> in_layer_;
  Slabs slabs_;
};

/// The rows `rows` of particles; `first`: the id of row 0.
Particles part_of(const Particles& all, const std::vector<int>& rows, std::int64_t first = 0);

}  // namespace pbf::exec_module
