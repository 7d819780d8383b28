// The ranks of this program, if it was started on several.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lib/exec/ranks/communicator.h"
#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace pbf::exec_module {

/// Null before open_world(), and if the program runs alone.
Communicator* world();
/// Opens the ranks with which a launcher has started the program. Throws Error(unavailable).
void open_world();
/// Not on rank 0: makes the solvers of rank 0 and serves them, until rank 0 ends. Returns its exit
/// code.
int serve_world();
/// On rank 0, as the last: the others end with the same code.
void end_world(int code);

/// On rank 0: a solver on all ranks, which get their particles in pieces. Throws as RankedSolver
/// does.
std::unique_ptr<Solver> make_ranked_solver(const Scene& scene, const Plan& plan,
                                           const ParticlePieces& particles);

/// On rank 0, between two solvers: positions of particles with ids from `first` to `last` - 1, of
/// `particles` in all, at the last call of moves() of the solver before, in h from Scene::origin().
std::vector<double> left_positions(std::int64_t particles, std::int64_t first, std::int64_t last);

}  // namespace pbf::exec_module
