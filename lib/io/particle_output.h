// Writes particle files, which bodies of shape `file` can read.
#pragma once

#include <string>

#include "lib/scene/particles.h"

namespace pbf::io_module {

/// Writes position (N, 3) in m and velocity (N, 3) in m/s as doubles into a new HDF5 file; row k is
/// particle k. Throws Error(io) with the path and the reason.
void write_particle_file(const std::string& path, const Particles& particles);

}  // namespace pbf::io_module
