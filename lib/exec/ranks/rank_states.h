// The state of a run on several ranks: in parts, and as a whole.
#pragma once

#include <algorithm>
#include <vector>

#include "lib/program/plan.h"
#include "lib/scene/particles.h"
#include "lib/solver/solver.h"

namespace pbf::exec_module {

std::vector<char> packed(const SolverState& state);
SolverState state_of(const std::vector<char>& packed);

/// The state of all particles, with the bits that a solver alone would return; only what took
/// energy is not spread over the sums of each cause (kernels/dissipation.h), of which the first
/// holds all. Made of the states of ranks, one after the other. scene, plan: those of a rank.
class WholeState {
 public:
  WholeState(StateOf which, const Scene& scene, const Plan& plan)
      : only_positions_(which == StateOf::positions), scene_(scene), plan_(plan) {}
  /// The first is that of rank 0.
  void add(const SolverState& part);
  SolverState result() &&;

 private:
  const bool only_positions_;
  const Scene& scene_;
  const Plan& plan_;
  SolverState all_{};
  bool empty_ = true;
};

/// The ids of the particles with which each rank begins: those in its layers, as nearly as this can
/// be said before positions have the solver's precision. The first sort moves the others.
using IdsOfRanks = std::vector<std::vector<int>>;
IdsOfRanks ids_of_ranks(const Particles& all, const Scene& scene, const Plan& plan, int ranks);
IdsOfRanks ids_of_ranks(const SolverState& all, const Plan& plan, int ranks);
/// What a rank gets. scene, plan: those of a rank.
Particles part_of(const Particles& all, const std::vector<int>& ids);
SolverState part_of(const SolverState& all, const std::vector<int>& ids, const Scene& scene,
                    const Plan& plan, int rank);

/// Copies row k of `from` to row places[k] of `to`.
template <class T>
void place_rows(const std::vector<T>& from, const std::vector<std::int64_t>& places,
                std::size_t numbers, std::vector<T>& to) {
  for (std::size_t k = 0; k < places.size(); ++k)
    std::copy_n(from.begin() + std::ptrdiff_t(k * numbers), numbers,
                to.begin() + std::ptrdiff_t(std::size_t(places[k]) * numbers));
}

}  // namespace pbf::exec_module
