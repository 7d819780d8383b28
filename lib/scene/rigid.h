// What the shape of a free body says of its motion: volume, center and second moments, and the
// points where it touches walls and other solids.
#pragma once

#include <vector>

#include "lib/scene/triangle_mesh.h"

namespace pbf::scene_module {

/// Integrals over a body of density 1, along its own axes. In two dimensions those over its section
/// by the plane, in m^2, m and m^4; there only the trace of `second` counts.
struct BodyMoments {
  double volume = 0;  ///< m^3
  Double3 center{};   ///< m, from Obstacle::middle()
  Matrix3 second{};   ///< m^5, of x_i x_j about the center
};
/// Of a body that is symmetric about its own axes. mean: m^2, means of x^2, y^2 and z^2.
inline BodyMoments symmetric_moments(double volume, const Double3& mean) {
  BodyMoments m;
  m.volume = volume;
  for (std::size_t k = 0; k < 3; ++k) m.second[k][k] = volume * mean[k];
  return m;
}
/// Of a closed mesh, about `from`, in the units of its vertices; exact. What two of its parts have
/// in common counts twice.
BodyMoments moments_of(const TriangleMesh& mesh, const Double3& from);

/// A place where a body may touch something: a ball, or a point of its surface if the radius is 0.
struct ContactPoint {
  Double3 at{};       ///< m, from Obstacle::middle(), along the axes of the body
  double radius = 0;  ///< m
};
inline constexpr std::size_t kMeshContacts = 96;
/// Vertices of a mesh, at most `most` (26 or more), as places times `by` from `from`: the outermost
/// ones along 26 directions, then each time the one farthest from all others.
std::vector<ContactPoint> contacts_of(const TriangleMesh& mesh, const Double3& from, double by,
                                      std::size_t most);

}  // namespace pbf::scene_module
