// Finds pairs of bodies whose bounding boxes are close to each other. Header only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "lib/scene/body_box.h"

namespace pbf::run_module {

/// Calls f(i, j) once for every pair of boxes that meet(), until it returns true. Returns whether a
/// call returned true.
template <class F>
bool any_near_pair(const std::vector<BodyBox>& boxes, double margin, F&& f) {
  Double3 extent{};
  for (const BodyBox& b : boxes)
    for (std::size_t a = 0; a < 3; ++a)
      extent[a] = std::max(extent[a], std::fabs(b.low[a] - boxes[0].low[a]));
  // Sorted along the axis of largest extent, a box can be near only to the next few boxes.
  const auto axis = std::size_t(std::max_element(extent.begin(), extent.end()) - extent.begin());
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return boxes[i].low[axis] < boxes[j].low[axis]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const BodyBox& a = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const BodyBox& b = boxes[order[j]];
      if (!(b.low[axis] < a.high[axis] + margin)) break;
      if (a.meets(b, margin) && f(order[i], order[j])) return true;
    }
  }
  return false;
}

/// Whether two bodies that are given by shapes are near each other.
inline bool any_near_bodies(const Scene& s, double margin) {
  std::vector<BodyBox> boxes;
  for (const Body& b : s.bodies) boxes.push_back(body_box(b));
  return any_near_pair(boxes, margin, [](std::size_t, std::size_t) { return true; });
}

}  // namespace pbf::run_module
