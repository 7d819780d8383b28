// Obstacles for the brute-force update: what they add to the density, by the formulas of
// kernels/boundary/solid_share.h integrated anew, and where paths end, by search. Long double, SI
// units. Shares no code with kernels/ or lib/.
#pragma once

#include <array>
#include <vector>

namespace oracle {

using Real = long double;
using V = std::array<Real, 3>;

struct Settings;

struct Solid {
  enum class Shape { plane, box, sphere, cylinder, capsule } shape = Shape::box;
  V center{}, half{};  ///< m; cylinder, capsule: the axis is body z, half[0] the radius
  /// Body axes in the frame of the scene, one in each row.
  std::array<V, 3> axes{V{1, 0, 0}, V{0, 1, 0}, V{0, 0, 1}};
};

/// m, below 0 inside, never steeper than 1; the distance near a face, an edge is farther than that.
Real level(const Solid& o, const V& x, int dimensions);

/// The sum over all solids of the share of the kernel that lies in them (Poly6 or Spiky), and its
/// gradient, 1/m. The range is that of walls.
Real share(const V& x, bool poly6, const Settings& c);
V share_gradient(const V& x, bool poly6, const Settings& c);

/// Where the way from one place to another ends: what is left of it behind the first contact goes
/// on along the plane that touches the solid there. Solids do not touch each other.
V path_end(const V& from, V to, const Settings& c);

}  // namespace oracle
