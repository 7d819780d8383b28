// The surface of a shape that is known by its distance alone. Header only.
#pragma once

#include <array>
#include <vector>

#include "kernels/shapes/shape.h"

namespace pbf::render_module {

/// In body coordinates.
using Triangle = std::array<Vec3<double>, 3>;

/// Where the distance is 0 in the tetrahedra of a lattice about the body, six to a cell; corners
/// are brought onto the surface.
std::vector<Triangle> zero_surface(const auto& shape, int cells = 32) {
  const Bounds<double> b = shape.bounds();
  const Vec3<double> edge = (1.02 / cells) * (b.high - b.low);
  const auto place = [&](int i, int j, int k) {
    return 0.5 * (b.low + b.high) + Vec3<double>{(i - 0.5 * cells) * edge.x,
                                                 (j - 0.5 * cells) * edge.y,
                                                 (k - 0.5 * cells) * edge.z};
  };
  std::vector<double> distance;
  for (int k = 0; k <= cells; ++k)
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i)
        distance.push_back(shape.template distance<3>(place(i, j, k)));
  struct Node {
    Vec3<double> x;
    double d;
  };
  std::vector<Triangle> all;
  const auto between = [&](const Node& a, const Node& c) {
    const Vec3<double> x = a.x + a.d / (a.d - c.d) * (c.x - a.x);
    return x - shape.template distance<3>(x) * shape.template normal<3>(x);
  };
  const auto cut = [&](const std::array<Node, 4>& corners) {
    std::vector<Node> in, out;
    for (const Node& n : corners) (n.d < 0 ? in : out).push_back(n);
    if (in.empty() || out.empty()) return;
    const std::vector<Node>&one = in.size() < out.size() ? in : out,
          &other = &one == &in ? out : in;
    const auto at = [&](std::size_t i, std::size_t k) { return between(one[i], other[k]); };
    if (one.size() == 1) return all.push_back({at(0, 0), at(0, 1), at(0, 2)});
    all.push_back({at(0, 0), at(0, 1), at(1, 1)});
    all.push_back({at(0, 0), at(1, 1), at(1, 0)});
  };
  // From the first corner of a cell to the last one along three edges.
  constexpr int ways[6][2] = {{1, 2}, {1, 4}, {2, 1}, {2, 4}, {4, 1}, {4, 2}};
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const auto node = [&](int corner) {
          const int x = i + (corner & 1), y = j + (corner >> 1 & 1), z = k + (corner >> 2);
          return Node{place(x, y, z),
                      distance[std::size_t((z * (cells + 1) + y) * (cells + 1) + x)]};
        };
        for (const auto& way : ways) cut({node(0), node(way[0]), node(way[0] + way[1]), node(7)});
      }
  return all;
}

}  // namespace pbf::render_module
