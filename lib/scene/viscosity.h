// The strength of viscosity and of the friction of walls, from their keys.
#pragma once

#include <algorithm>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// What one sweep of viscosity does: v_i += factor * sum_j vol W_ij (v_j - v_i).
struct ViscousSweeps {
  int sweeps = 0;     ///< per update; 0: there is no viscosity
  double factor = 0;  ///< of a sweep, with time.step as it is
};

/// A sweep with a kinematic viscosity has a factor of at most 1: then no difference of velocities
/// changes its sign. With friction half of that, because walls act between two sweeps and fluid
/// near them would otherwise lag behind by a few percent of a spacing.
constexpr double most_of_sweep(bool friction) { return friction ? 0.5 : 1; }
/// The viscosity of the method itself where fluid deforms, about this times speed times
/// fluid.spacing (tests/regression/periodic).
inline constexpr double kOwnViscosity = 0.2;
/// With more sweeps per update, time.step is too long for the viscosity.
inline constexpr int kMostSweeps = 64;

/// M in h^2: a sweep with factor c in a step dt acts like nu = c M h^2/dt. M = 1/2 sum vol W z^2
/// over the rest lattice (kernels/README.md, "Viscosity in physical units").
double viscous_moment(const Scene& scene);
/// C of the share that a wall at distance q (in h) takes of the difference to its velocity in a
/// sweep, C factor F(q)/q, F: the first moment of the kernel over the half space. C makes a layer
/// of the rest lattice at d/2 feel the layers that are not there.
double friction_scale(const Scene& scene);

inline bool has_wall_friction(const Scene& s) {
  for (int face = 0; face < int(kFaceNames.size()); ++face)
    if (!(s.dimensions == 2 && face / 2 == 1) && s.domain.friction_of(face) > 0) return true;
  return false;
}
inline bool has_obstacle_friction(const Scene& s) {
  return std::any_of(s.obstacles.begin(), s.obstacles.end(),
                     [](const Obstacle& o) { return o.friction > 0; });
}
inline bool has_friction(const Scene& s) {
  return has_wall_friction(s) || has_obstacle_friction(s);
}

/// Of the updates of the scene. Never more than kMostSweeps.
ViscousSweeps viscous_sweeps(const Scene& scene);
/// The factor of each of so many sweeps in an update of time.step.
double factor_of_sweep(const Scene& scene, int sweeps);
/// m^2/s, the viscosity of the keys `xsph` or `kinematic`; 0: none.
double kinematic_viscosity(const Scene& scene);
/// s, the longest step for which kMostSweeps are enough.
double longest_viscous_step(const Scene& scene);

}  // namespace pbf::scene_module
