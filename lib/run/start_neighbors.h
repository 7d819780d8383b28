// Estimates the numbers of neighbors of an initial state, before its particles are created.
#pragma once

#include <cstdint>

#include "lib/program/plan.h"
#include "lib/run/emit.h"

namespace pbf::run_module {

/// Empty if no place can be denser than fluid at rest: blocks and spheres without overlap. Takes
/// time proportional to `particles` (count_particles()), and memory only for the sample. The sample
/// of a scene is always the same. Positions outside the domain are no error here.
StartNeighbors start_neighbors(const StartPoints& points, std::int64_t particles);

}  // namespace pbf::run_module
