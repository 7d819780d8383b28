// The displacement of solver.levels by its definition: every coarse node asks every finer one.
#pragma once

#include "tests/oracle/n2_update.h"

namespace oracle {

/// What the nodes of the finest level were, so that a test sees that it tests something.
struct LevelNodes {
  int levels = 0, on = 0, off = 0;
  int free = 0;          ///< particles and axes, moved without a wall that holds the fluid
  Real closest = 1e30L;  ///< particles, least distance of a cell from being just half full
  int reached = 0;       ///< cells that are half full, but an obstacle may reach into
  Real touch = 1e30L;    ///< h, least distance of an obstacle from just reaching such a cell
};

/// m, of each particle. in_cell: where the particles were when the lists were made; ratio: their
/// densities over rest density now.
std::vector<V> level_moves(const std::vector<V>& in_cell, const std::vector<Real>& ratio,
                           const Settings& c, LevelNodes& found);

}  // namespace oracle
