// Visits every initial position of a scene without storing them. Header only.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lib/run/emit.h"
#include "lib/scene/points.h"

namespace pbf::inline run_module {

/// The particles of a scene in the order of their ids, before any check of them. Files of bodies
/// are read once and kept.
class StartPoints {
 public:
  /// Throws as emit_particles() does for a file that cannot be read.
  StartPoints(const Scene& scene, const std::string& scene_dir) : scene_(scene) {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (scene.bodies[b].shape == Shape::file)
        files_.push_back(particles_of_file(scene, b, scene_dir));
  }
  /// f(index of the body, place in m). In two dimensions every place is on the plane.
  template <class F>
  void for_each(F&& f) const {
    const std::optional<double> plane = scene_.plane();
    std::size_t file = 0;
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const auto put = [&](Double3 x) {
        if (plane) x[1] = *plane;
        f(b, x);
      };
      if (scene_.bodies[b].shape != Shape::file)
        for_each_point(scene_.bodies[b], scene_.fluid.spacing, plane, put);
      else
        for (const Double3& x : files_[file++].position) put(x);
    }
  }

 private:
  const Scene& scene_;
  std::vector<Particles> files_;
};

}  // namespace pbf::inline run_module
