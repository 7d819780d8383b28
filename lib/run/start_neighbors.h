// Estimates how crowded an initial state is, before its particles are created.
#pragma once

#include <cstdint>
#include <string>
#include "lib/program/plan.h"
#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// Empty where no place can be denser than fluid at rest: blocks and spheres that do not overlap.
/// Takes time in proportion to `particles`, of count_particles(), and memory for the sample alone,
/// but for the particles of file bodies, which are read. The same sample for the same scene. Throws
/// as emit_particles() does for a file that cannot be read; places outside the domain are no error
/// here.
StartNeighbors start_neighbors(const Scene& scene, const std::string& scene_dir,
                               std::int64_t particles);

}  // namespace pbf::inline run_module
