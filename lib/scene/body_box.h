// Boxes about bodies, and whether a place is in a body. Header only.
#pragma once

#include <algorithm>
#include <cmath>

#include "lib/scene/scene.h"
#include "lib/scene/vector3.h"

namespace pbf::scene_module {

/// Edges parallel to the axes.
struct BodyBox {
  Double3 low, high;
  bool holds(const Double3& x, double margin) const { return meets({x, x}, margin); }
  /// Whether the boxes touch or overlap when one is enlarged by `margin` (may be negative).
  bool meets(const BodyBox& other, double margin) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (!(low[a] - margin <= other.high[a] && other.low[a] <= high[a] + margin)) return false;
    return true;
  }
  /// Enlarges it to hold the other.
  void add(const BodyBox& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
  }
};

/// Holds nothing; add() makes it the other one.
inline constexpr BodyBox kNoBox{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};

/// m. Of a block, random box, sphere or cylinder; a file or mesh has none before it is read.
inline BodyBox body_box(const Body& b) {
  BodyBox box{b.min, b.max};
  if (b.shape == Shape::sphere) {
    box = {b.center, b.center};
    for (std::size_t a = 0; a < 3; ++a) box.low[a] -= b.radius, box.high[a] += b.radius;
  }
  if (b.shape == Shape::cylinder && b.from != b.to) {
    const Double3 axis = unit(b.to - b.from);
    for (std::size_t a = 0; a < 3; ++a) {
      const double out = b.radius * std::sqrt(std::max(0.0, 1 - axis[a] * axis[a]));
      box.low[a] = std::min(b.from[a], b.to[a]) - out;
      box.high[a] = std::max(b.from[a], b.to[a]) + out;
    }
  }
  return box;
}

/// Whether a place is in a body that is given by a shape, enlarged by `margin` (m, may be
/// negative).
inline bool is_in(const Body& b, const Double3& x, double margin) {
  if (b.from_file()) return false;
  if (b.shape == Shape::sphere) return length(x - b.center) <= b.radius + margin;
  if (b.shape != Shape::cylinder) return body_box(b).holds(x, margin);
  const Double3 axis = unit(b.to - b.from), off = x - b.from;
  const double along = dot(off, axis);
  return along >= -margin && along <= length(b.to - b.from) + margin &&
         length(off - along * axis) <= b.radius + margin;
}

}  // namespace pbf::scene_module
