// The particles of a snapshot as the graphics card wants them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lib/render/camera.h"
#include "lib/render/colormap.h"
#include "lib/render/renderer.h"

namespace pbf::render_module {

struct ParticleVertex {
  /// Centre in view space (x, y, depth), m: subtracted and turned in double before rounding.
  std::array<float, 3> place;
  Rgb color;
  std::uint8_t share;  ///< where on the colour bar, 0 to 254; kNoShare without a value
};
inline constexpr std::uint8_t kNoShare = 255;

struct ParticleVertices {
  std::vector<ParticleVertex> list;      ///< those in the picture first
  std::size_t visible = 0;               ///< how many are; the rest may cast a shadow into it
  double nearest = 1e300, farthest = 0;  ///< depth of the surfaces, m
};

/// m, of the spheres that are drawn: larger for a surface, so that no ray passes between particles
/// that rest as a lattice.
double drawn_radius(const View& view);

/// The particles in front of the eye and inside the picture, coloured; behind them, but not of a
/// scene in two dimensions, the others. Particles with a position that is not finite are left out.
/// Throws Error(bad_input) when a field is missing or misshapen.
void collect(const Snapshot& snapshot, const View& view, const Projection& projection,
             ParticleVertices& out);

/// Throws Error(bad_input) unless `snapshot` has what a picture coloured by `color` reads.
void check_fields(const Snapshot& snapshot, ColorBy color);

/// What colours the particle of row i: `field` is the one of the view's colouring, checked.
double shown_value(const FieldArray& field, const View& view, std::size_t i);

}  // namespace pbf::render_module
