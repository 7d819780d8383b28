// Finds pairs of bodies whose bounding boxes are close to each other. Header only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "lib/scene/body_box.h"

namespace pbf::inline run_module {

/// Edges parallel to the axes, m.
struct Box {
  Double3 low, high;
  bool holds(const Double3& x, double margin) const {
    for (int a = 0; a < 3; ++a)
      if (!(x[a] >= low[a] - margin && x[a] <= high[a] + margin)) return false;
    return true;
  }
  /// Whether the boxes overlap when each is enlarged by half of `margin` (may be negative).
  bool near(const Box& other, double margin) const {
    for (int a = 0; a < 3; ++a)
      if (high[a] + margin <= other.low[a] || other.high[a] + margin <= low[a]) return false;
    return true;
  }
};

/// The bounding box of a body, as in body_box().
inline Box box_of(const Body& b) {
  const BodyBox box = body_box(b);
  return {box.low, box.high};
}

/// Calls f(i, j) once for every pair of boxes that are near(), until it returns true. Returns
/// whether a call returned true.
template <class F>
bool any_near_pair(const std::vector<Box>& boxes, double margin, F&& f) {
  Double3 extent{};
  for (const Box& b : boxes)
    for (std::size_t a = 0; a < 3; ++a)
      extent[a] = std::max(extent[a], std::fabs(b.low[a] - boxes[0].low[a]));
  // Sorted along the axis of largest extent, a box can be near only to the next few boxes.
  const auto axis = std::size_t(std::max_element(extent.begin(), extent.end()) - extent.begin());
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return boxes[i].low[axis] < boxes[j].low[axis]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box& a = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Box& b = boxes[order[j]];
      if (!(b.low[axis] < a.high[axis] + margin)) break;
      if (a.near(b, margin) && f(order[i], order[j])) return true;
    }
  }
  return false;
}

}  // namespace pbf::inline run_module
