// Reads and creates the particles of a scene's bodies.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lib/scene/particles.h"
#include "lib/scene/points.h"
#include "lib/scene/scene.h"

namespace pbf::run_module {

/// The particles of a scene in the order of their ids, before any check. The file of a body is
/// opened only here, once, and its particles are kept, so that all users see the same particles.
class StartPoints {
 public:
  /// `scene` must outlive this object; `scene_dir` anchors relative paths. Throws what
  /// read_particle_file() throws, and Error(bad_input) for a file without particles. Messages name
  /// the place in the scene that names the file.
  StartPoints(const Scene& scene, const std::string& scene_dir);
  /// Calls f(index of the body, position in m). In two dimensions every position is on the plane.
  template <class F>
  void for_each(F&& f) const {
    const std::optional<double> plane = scene_.plane();
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const auto put = [&](Double3 x) {
        if (plane) x[1] = *plane;
        f(b, x);
      };
      if (!scene_.bodies[b].from_file())
        for_each_point(scene_.bodies[b], scene_.fluid.spacing, plane, put);
      else
        for (const Double3& x : of_files_[b].position) put(x);
    }
  }
  const Scene& scene() const { return scene_; }
  const Particles& of_file(std::size_t body) const { return of_files_[body]; }
  /// Frees the particles of a file.
  void drop_file(std::size_t body) { of_files_[body] = {}; }
  /// Those of bodies, which were opened here, then those that read_linked_files() has read.
  const std::vector<SceneFile>& files() const { return files_; }

 private:
  const Scene& scene_;
  std::vector<Particles> of_files_;  // empty for bodies that are not files
  std::vector<SceneFile> files_;
};

/// Number of particles of the scene's bodies; creates none. Throws Error(bad_input) if the number
/// is 0 or above 2^31 - 1.
std::int64_t count_particles(const StartPoints& points);

/// Creates the particles of every body in the order of the list, and frees those of files on the
/// way. Block: lattice points min + (i + 1/2) d for every cell of edge d that fits (to rounding);
/// sphere: points of the lattice through its center with |x - c| <= radius; random_box: SplitMix64
/// seeded by `seed`, three draws per particle (x, y, z), 53-bit mantissa, the same on every
/// machine. In two dimensions each shape is cut with the plane: square lattice, disc, two draws (x,
/// z); particles of a file within the slab are put on the plane. Particles nearer to a wall than
/// solver.wall_margin are moved to that distance, by up to half a spacing: the first update would
/// clamp them and turn the move into a velocity. Mesh: points_in() its surface. Throws
/// Error(bad_input) for a particle outside the domain, or if a larger move is needed.
Particles emit_particles(StartPoints points);
/// The same in pieces of at most `most` particles, without memory for all; those of files stay.
/// Returns what Particles say besides. take may be null.
Particles emit_in_pieces(StartPoints& points, std::int64_t most, const TakeParticles& take);

inline std::int64_t count_particles(const Scene& scene, const std::string& scene_dir) {
  return count_particles(StartPoints(scene, scene_dir));
}
inline Particles emit_particles(const Scene& scene, const std::string& scene_dir) {
  return emit_particles(StartPoints(scene, scene_dir));
}

}  // namespace pbf::run_module
