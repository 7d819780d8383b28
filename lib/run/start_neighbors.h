// Estimates how crowded an initial state is, before its particles are created.
#pragma once

#include <cstdint>

#include "lib/program/plan.h"
#include "lib/run/emit.h"

namespace pbf::inline run_module {

/// Empty where no place can be denser than fluid at rest: blocks and spheres that do not overlap.
/// Takes time in proportion to `particles`, of count_particles(), and memory for the sample alone.
/// The same sample for the same scene. Places outside the domain are no error here.
StartNeighbors start_neighbors(const StartPoints& points, std::int64_t particles);

}  // namespace pbf::inline run_module
