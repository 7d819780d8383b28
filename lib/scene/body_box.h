// The bounding box of a body that is given by a shape. Header only.
#pragma once

#include <algorithm>
#include <cmath>

#include "lib/scene/scene.h"
#include "lib/scene/vector3.h"

namespace pbf::inline scene_module {

/// Corners, m.
struct BodyBox {
  Double3 low, high;
};

/// Of a block, random box, sphere or cylinder; a file has none before it is read.
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

}  // namespace pbf::inline scene_module
