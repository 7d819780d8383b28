// The box of the domain and its floor as triangles in view space.
#pragma once

#include <array>
#include <vector>

#include "lib/render/camera.h"
#include "lib/render/colormap.h"

namespace pbf::render_module {

struct FlatVertex {
  std::array<float, 3> place;  ///< view space: x, y, depth, m
  Rgb color;
};

/// Lines are drawn on the same lines of sight, nearer by this factor: they win over surfaces.
inline constexpr double kNearer = 0.999;

/// Appends the line from a to b (view space, m), `width` pixels wide, as triangles that face the
/// eye; what is nearer than `near_depth` (m) is cut off.
void add_line(Double3 a, Double3 b, Rgb color, const Projection& projection, double width,
              double near_depth, std::vector<FlatVertex>& out, double nearer = kNearer);

/// Appends the 12 edges of the box as lines, in two dimensions those of the face before the plane.
void add_box_edges(const View& view, const Projection& projection, double width, double near_depth,
                   std::vector<FlatVertex>& out);

/// Whether the face of the domain that lies lowest has no wall.
bool floor_is_open(const View& view);
/// Whether there is a floor, and the eye is above it. Of a scene in two dimensions there is none.
bool sees_floor(const View& view, const Projection& projection);

/// Appends the lowest face of the box, when the eye sees it.
void add_floor(const View& view, const Projection& projection, std::vector<FlatVertex>& out);

}  // namespace pbf::render_module
