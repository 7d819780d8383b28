// Reads particles from text: x,y,z or x,y,z,vx,vy,vz, one particle per line.
#pragma once

#include <cstdint>
#include <string>

#include "lib/base/regular_file.h"
#include "lib/base/sha256.h"
#include "lib/scene/particles.h"

namespace pbf::io_module {

/// Reads particles as read_particle_file() says. `hash`: gets every byte that was read, if given.
/// Throws Error(bad_input) naming line and column. No message shows a line of a file that has not
/// begun as a particle file does: a scene from elsewhere may name any file of this machine.
Particles read_particle_csv(RegularFile& file, const std::string& path, Sha256* hash);

}  // namespace pbf::io_module
