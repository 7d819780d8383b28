// Particle files: what bodies of shape `file` read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/emit.h"

namespace pbf {

/// Writes position (N, 3) in m and velocity (N, 3) in m/s as doubles into a new HDF5 file, and
/// which particle of the run each row was (id). Throws Error(io) with the path and the reason.
void write_particle_file(const std::string& path, const Particles& particles,
                         const std::vector<std::int32_t>& id);

}  // namespace pbf
