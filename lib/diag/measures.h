// What a run reports about its own state: scalars over all particles.
#pragma once

#include <cstdint>

namespace pbf {

/// SI units. Compression of a particle: c = max(rho/rho0 - 1, 0), walls' contribution included.
struct Measures {
  double time = 0;  ///< s
  std::int64_t update = 0;
  double compression_mean = 0;           ///< 1
  double compression_rms = 0;            ///< 1
  double compression_max = 0;            ///< 1
  double kinetic_energy = 0;             ///< J
  double potential_energy = 0;           ///< J, -m g.x relative to the domain's lower corner
  double momentum[3] = {0, 0, 0};        ///< kg m/s
  double center_of_mass[3] = {0, 0, 0};  ///< m
  double speed_max = 0;                  ///< m/s
  double front[3] = {0, 0, 0};           ///< m, largest coordinate along each axis
  double neighbors_mean = 0;             ///< without the particle itself
  std::int64_t neighbors_max = 0;
  std::int64_t outside = 0;     ///< particles beyond a wall
  std::int64_t non_finite = 0;  ///< particles with a non-finite position or velocity
  /// Particles times updates, since the start, above solver.speed_limit (which were slowed down to
  /// it), or without one above guard.speed.
  std::int64_t fast = 0;
};

}  // namespace pbf
