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

/// edge: the way to the next corner is on the surface.
struct SectionCorner {
  Vec3<double> place;
  bool edge;
};

/// The part of the parallelogram corner + s u + t w, s and t from 0 to 1, in which distance(x) is
/// below 0: polygons in the triangles of a lattice, two to a cell.
std::vector<std::vector<SectionCorner>> zero_section(const auto& distance,
                                                     const Vec3<double>& corner,
                                                     const Vec3<double>& u, const Vec3<double>& w,
                                                     int cells = 64) {
  struct Node {
    Vec3<double> x;
    double d;
  };
  std::vector<Node> nodes;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const Vec3<double> x = corner + double(i) / cells * u + double(j) / cells * w;
      nodes.push_back({x, distance(x)});
    }
  std::vector<std::vector<SectionCorner>> all;
  const auto add = [&](const std::array<Node, 3>& corners) {
    std::vector<SectionCorner> part;
    for (std::size_t k = 0; k < 3; ++k) {
      const Node &a = corners[k], &b = corners[(k + 1) % 3];
      if (a.d <= 0) part.push_back({a.x, false});
      if ((a.d <= 0) != (b.d <= 0))
        part.push_back({a.x + a.d / (a.d - b.d) * (b.x - a.x), a.d <= 0});
    }
    if (!part.empty()) all.push_back(std::move(part));
  };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto node = [&](int right, int up) {
        return nodes[std::size_t((j + up) * (cells + 1) + i + right)];
      };
      add({node(0, 0), node(1, 0), node(1, 1)});
      add({node(0, 0), node(1, 1), node(0, 1)});
    }
  return all;
}

}  // namespace pbf::render_module
