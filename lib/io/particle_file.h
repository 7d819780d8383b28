// Particle files, which bodies of shape `file` are read from.
#pragma once

#include <string>

#include "lib/scene/particles.h"

namespace pbf::io_module {

/// Reads positions (m) and velocities (m/s; zero when the file has none) of every particle.
/// HDF5 (known by its signature): dataset `position` of shape (N, 3), optional `velocity` (N, 3),
/// any number type. Anything else is read as CSV: header `x,y,z` or `x,y,z,vx,vy,vz`, then one
/// particle per line; CRLF and empty lines are tolerated.
/// `sha256`: gets the SHA-256 of the bytes that were read, if given.
/// The file is opened once: all that is told of it is of the same bytes. A child process reads an
/// HDF5 file first, so that one on which HDF5 crashes is an error.
/// Throws Error(io) when the file cannot be read, is no regular file, was written to meanwhile
/// (HDF5), crashes HDF5, or leads into other files; Error(bad_input) naming file and line (CSV) or
/// dataset and row (HDF5) when it cannot be understood or a value is not finite; Error(unavailable)
/// when the memory that is available does not hold an HDF5 file and its particles, or twice a CSV.
Particles read_particle_file(const std::string& path, std::string* sha256 = nullptr);

/// Writes position (N, 3) in m and velocity (N, 3) in m/s as doubles into a new HDF5 file; row k is
/// particle k. Throws Error(io) with the path and the reason.
void write_particle_file(const std::string& path, const Particles& particles);

}  // namespace pbf::io_module
