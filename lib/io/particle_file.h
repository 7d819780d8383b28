// Reads particles from files, for bodies of shape `file`.
#pragma once

#include <cstdint>
#include <string>

#include "lib/scene/particles.h"

namespace pbf::inline io_module {

/// Reads positions (m) and velocities (m/s; zero when the file has none) of every particle.
/// HDF5 (known by its signature): dataset `position` of shape (N, 3), optional `velocity` (N, 3),
/// any number type. Anything else is read as CSV: header `x,y,z` or `x,y,z,vx,vy,vz`, then one
/// particle per line; CRLF and empty lines are tolerated.
/// `sha256`: gets the SHA-256 of the bytes that were read, if given.
/// Throws Error(io) when the file cannot be read, is no regular file, or leads into other files,
/// Error(bad_input) naming file and line (CSV) or dataset and row (HDF5) when it cannot be
/// understood or a value is not finite.
Particles read_particle_file(const std::string& path, std::string* sha256 = nullptr);

/// Number of particles read_particle_file would give, without keeping them. HDF5: from the shape of
/// the dataset; CSV: lines are counted, not parsed. Same errors for what it looks at;
/// an HDF5 file is read by a child process first, and Error(io) when HDF5 crashes on it.
std::int64_t count_particle_file(const std::string& path);

}  // namespace pbf::inline io_module
