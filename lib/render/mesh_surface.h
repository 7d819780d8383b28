// What is drawn of a surface of triangles.
#pragma once

#include <array>
#include <vector>

#include "lib/scene/solid_mesh.h"

namespace pbf::render_module {

/// Body coordinates, m.
struct MeshTriangle {
  std::array<Double3, 3> place;
  std::array<Double3, 3> normal;  ///< of the surface that goes on smoothly, unit vectors
  std::array<bool, 3> crease;     ///< the edge to the next corner is sharp
};

/// meters: of a unit of the file. Edges are sharp where triangles meet at more than 35 degrees.
/// Triangles without area are left out.
std::vector<MeshTriangle> drawn_triangles(const SolidMesh& surface, double meters);

}  // namespace pbf::render_module
