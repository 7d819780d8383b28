// The obstacles of a scene as triangles in view space.
#pragma once

#include <array>
#include <vector>

#include "lib/render/box.h"
#include "lib/render/camera.h"

namespace pbf::render_module {

inline constexpr Rgb kCrease{118, 104, 90};  ///< colour of creases

inline constexpr std::array<double, 3> kClay{190, 176, 160};  ///< of 255: neither the cool greys
                                                              ///< of the box nor viridis

struct SolidVertex {
  std::array<float, 3> place;   ///< view space: x, y, depth, m
  std::array<float, 3> normal;  ///< out of the solid, of the smooth surface; view space
};

struct SolidSurfaces {
  std::vector<SolidVertex> triangles;           ///< three corners each
  std::vector<SolidVertex> casters;             ///< faces away from the sun; empty in 2-D
  std::vector<std::array<Double3, 2>> creases;  ///< ends of the sharp edges, view space, m
};

/// The surfaces of the obstacles that face the eye; round ones are inscribed, within 0.25 % of
/// their radius. A solid ends at the walls of the domain, where its cut is drawn; it goes on behind
/// an open face, but a plane does not. Of a scene in two dimensions a thin slice at its plane is
/// drawn. Surfaces are opaque: an obstacle between the eye and the fluid hides it, and another
/// camera shows it. `sun`: unit vector towards it, along the scene's axes.
SolidSurfaces surfaces_of(const View& view, const Projection& projection, const Double3& sun);

}  // namespace pbf::render_module
