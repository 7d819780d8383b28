// The state of a run on several ranks: in parts, and as a whole.
#pragma once

#include <algorithm>
#include <vector>

#include "lib/program/plan.h"
#include "lib/solver/solver_state.h"

namespace pbf::exec_module {

std::vector<char> packed(const SolverState& state);
SolverState state_of(const std::vector<char>& packed);

/// The state of all particles, with the bits that a solver alone would return; only what took
/// energy is not spread over the sums of each cause (kernels/dissipation.h), of which the first
/// holds all. scene, plan: those of a rank. first: that of rank
/// 0; parts: packed(), of all ranks.
SolverState whole_state(const SolverState& first, const std::vector<std::vector<char>>& parts,
                        const Scene& scene, const Plan& plan);
/// What a rank gets of it: a range of ids. The next sort brings particles to the rank of their
/// place.
SolverState part_of_state(const SolverState& all, const Scene& scene, const Plan& plan, int rank,
                          int ranks);

/// Copies row k of `from` to row places[k] of `to`.
template <class T>
void place_rows(const std::vector<T>& from, const std::vector<std::int64_t>& places,
                std::size_t numbers, std::vector<T>& to) {
  for (std::size_t k = 0; k < places.size(); ++k)
    std::copy_n(from.begin() + std::ptrdiff_t(k * numbers), numbers,
                to.begin() + std::ptrdiff_t(std::size_t(places[k]) * numbers));
}

}  // namespace pbf::exec_module
