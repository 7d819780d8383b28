// The obstacles of a scene as lit triangles in view space.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lib/render/box.h"
#include "lib/render/camera.h"

namespace pbf::inline render_module {

inline constexpr std::array<std::uint8_t, 4> kCrease{118, 104, 90, 0};  ///< colour of creases

struct SolidSurfaces {
  std::vector<FlatVertex> triangles;            ///< three corners each, coloured by the light
  std::vector<std::array<Double3, 2>> creases;  ///< ends of the sharp edges, view space, m
};

/// The surfaces of the obstacles that face the eye; round ones are inscribed, within 0.25 % of
/// their radius. A solid ends at the walls of the domain, where its cut is drawn; it goes on behind
/// an open face, but a plane does not. Of a scene in two dimensions a thin slice at its plane is
/// drawn. Surfaces are opaque: an obstacle between the eye and the fluid hides it, and another
/// camera shows it.
SolidSurfaces surfaces_of(const View& view, const Projection& projection);

}  // namespace pbf::inline render_module
