// Mass, center of mass and inertia of free bodies, and where they touch other solids.
#pragma once

#include "lib/scene/rigid.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

/// Of a body whose density is the same everywhere, at its pose in the scene file; exact but for
/// rounding. In two dimensions of 1 m of width: forces of the fluid are those of the slab, and are
/// divided by its thickness to go with it.
struct BodyMass {
  double volume = 0;  ///< m^3; in two dimensions m^2
  double mass = 0;    ///< kg; in two dimensions kg/m
  Double3 center{};   ///< m, along the scene's axes
  /// kg m^2, about that center, along the scene's axes; in two dimensions only [1][1], kg m.
  Matrix3 inertia{};
};
/// The obstacle is a free body; a mesh has been read.
BodyMass body_mass(const Scene& scene, const Obstacle& obstacle);

/// Where the body may touch walls and other solids, along its own axes (lib/scene/rigid.h). None
/// for planes and heights.
std::vector<ContactPoint> contact_points(const Scene& scene, const Obstacle& obstacle);

}  // namespace pbf::program_module
