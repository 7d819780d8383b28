// The initial particles on the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/scene/scene_files.h"

namespace pbf::scene_module {

/// Initial particles in id order, SI units.
struct Particles {
  std::vector<Double3> position;            ///< m
  std::vector<Double3> velocity;            ///< m/s
  std::vector<int> ids{};                   ///< empty: 0, 1, 2, ...
  std::size_t put_on_margin = 0;            ///< moved to solver.wall_margin from a wall
  double farthest_put = 0;                  ///< m, the longest of these moves
  std::vector<std::size_t> in_obstacles{};  ///< removed per body; empty: no obstacles
  std::vector<SceneFile> files;  ///< that were read: of bodies in their order, then of motions
  std::size_t size() const { return position.size(); }
};

/// Gives initial particles in pieces, in the order of ids, in each call from the first one on:
/// calls take(id of the first, particles), whose `ids` are empty. Null: there are none.
using TakeParticles = std::function<void(std::int64_t first, Particles&& piece)>;
using ParticlePieces = std::function<void(const TakeParticles& take)>;

}  // namespace pbf::scene_module
