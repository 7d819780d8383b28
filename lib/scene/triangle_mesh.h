// Surfaces of triangles: whether they enclose a volume, and the lattice points inside.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/scene/vector3.h"

namespace pbf::scene_module {

struct TriangleMesh {
  std::vector<Double3> vertex;                        ///< m, all different
  std::vector<std::array<std::int32_t, 3>> triangle;  ///< counterclockwise seen from outside
  const Double3& corner(std::size_t t, std::size_t k) const {
    return vertex[std::size_t(triangle[t][k])];
  }
};

/// Where a mesh stands in a scene: scaled, then turned about the origin, then moved.
struct MeshPlace {
  double scale = 1;
  Double3 turn_axis{0, 0, 1};
  double turn_angle = 0;  ///< degrees, by the right-hand rule
  Double3 translate{};    ///< m
};
void place(TriangleMesh& mesh, const MeshPlace& at);

/// Corners of the box about it. It must have a vertex.
std::array<Double3, 2> box_of(const TriangleMesh& mesh);

/// m^3; below 0 if the triangles are seen clockwise from outside.
double volume_of(const TriangleMesh& mesh);

/// Throws Error(bad_input) unless each edge belongs to two triangles that turn alike, and the
/// volume is above 0. Names the first edges that do not, in the units of the vertices. file: begins
/// the message.
void require_closed(const TriangleMesh& mesh, const std::string& file);

/// Where a line along x at (y, z) crosses the surface.
struct Crossing {
  double x;
  int winding;  ///< 1 inwards along x, -1 outwards
};
/// By growing x, of a line near (y, z) at most: as often inwards as outwards. among: triangles with
/// all that the line may meet. d: a length that is small beside the mesh, m, of whose millionth the
/// line may be moved.
std::vector<Crossing> crossings(const TriangleMesh& mesh, const std::vector<std::int32_t>& among,
                                double y, double z, double d);

/// The points low + (i + 1/2) d inside, where low is the lower corner of its box, with x fastest. A
/// box as a mesh has the points of a block. Where parts of a mesh overlap, a point counts once.
/// plane: points of the square lattice in y = *plane instead. Needs a closed mesh.
std::vector<Double3> points_in(const TriangleMesh& mesh, double d, std::optional<double> plane);

}  // namespace pbf::scene_module
