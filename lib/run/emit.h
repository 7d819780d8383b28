// Creates the particles of a scene's bodies.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/scene/particles.h"
#include "lib/scene/scene.h"

namespace pbf::inline run_module {

/// Path of a file body's file.
std::string resolved_path(const Body& body, const std::string& scene_dir);

/// The particles of a file body. What is wrong with its file is told with the place in the scene
/// that names it; else throws as read_particle_file(), and takes `sha256` as that does.
Particles particles_of_file(const Scene& scene, std::size_t body, const std::string& scene_dir,
                            std::string* sha256 = nullptr);

/// The files of the scene's bodies and motions, in their order, as they are now. Throws as
/// emit_particles().
std::vector<SceneFile> scene_files(const Scene& scene, const std::string& scene_dir);

/// Number of particles the scene's bodies make, without making them (file bodies are opened).
/// Throws Error(bad_input) when the number is 0 or above 2^31 - 1.
std::int64_t count_particles(const Scene& scene, const std::string& scene_dir);

/// Makes the particles of every body in order of the list. `scene_dir` anchors relative paths.
/// Block: lattice points min + (i + 1/2) d for every cell of edge d that fits (to rounding);
/// sphere: points of the lattice through its centre with |x - c| <= radius; random_box: SplitMix64
/// seeded by `seed`, three draws per particle (x, y, z), 53-bit mantissa, the same on every
/// machine. In two dimensions each of them is its cut with the plane: square lattice, disc, two
/// draws (x, z); particles of a file within the slab are put on it. Particles nearer to a wall than
/// solver.wall_margin are put on that distance, by up to half a spacing: the first update would
/// clamp them, and take the way for a velocity.
/// Throws Error(bad_input) for a particle outside the domain or farther behind the margin, a
/// file body that cannot be understood, non-finite values; Error(io) for one that cannot be read.
Particles emit_particles(const Scene& scene, const std::string& scene_dir);

}  // namespace pbf::inline run_module
