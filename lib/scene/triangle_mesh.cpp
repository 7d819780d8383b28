#include "lib/scene/triangle_mesh.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lib/base/error.h"
#include "lib/scene/number.h"

namespace pbf::scene_module {
namespace {

/// An edge between two vertices, low < high, of a triangle that runs along it upwards or downwards.
struct Edge {
  std::int32_t low, high;
  bool up;
  auto operator<=>(const Edge&) const = default;
  bool same(const Edge& o) const { return low == o.low && high == o.high; }
};

std::vector<Edge> edges_of(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangle.size());
  for (const auto& t : mesh.triangle)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// The edges of one kind: how many, and the first of them.
struct Found {
  std::size_t count = 0;
  std::vector<Edge> first;
  void add(const Edge& e) {
    if (++count <= 3) first.push_back(e);
  }
  std::string text(const TriangleMesh& mesh) const {
    std::string out;
    for (const Edge& e : first)
      out += fmt::format("{}{} to {}", out.empty() ? "" : ", ",
                         to_text(mesh.vertex[std::size_t(e.low)]),
                         to_text(mesh.vertex[std::size_t(e.high)]));
    return out + (count > first.size() ? ", ..." : "");
  }
};

}  // namespace

void place(TriangleMesh& mesh, const MeshPlace& at) {
  const Matrix3 axes = axes_turned(at.turn_axis, at.turn_angle);
  for (Double3& x : mesh.vertex) {
    const Double3 s = at.scale * x;
    x = s[0] * axes[0] + s[1] * axes[1] + s[2] * axes[2] + at.translate;
  }
}

std::array<Double3, 2> box_of(const TriangleMesh& mesh) {
  std::array<Double3, 2> box{mesh.vertex.front(), mesh.vertex.front()};
  for (const Double3& x : mesh.vertex)
    for (std::size_t a = 0; a < 3; ++a) {
      box[0][a] = std::min(box[0][a], x[a]);
      box[1][a] = std::max(box[1][a], x[a]);
    }
  return box;
}

double volume_of(const TriangleMesh& mesh) {
  if (mesh.triangle.empty()) return 0;
  const Double3 from = mesh.corner(0, 0);  // near it, so that far meshes lose no digits
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    sum += dot(mesh.corner(t, 0) - from, cross(mesh.corner(t, 1) - from, mesh.corner(t, 2) - from));
  return sum / 6;
}

void require_closed(const TriangleMesh& mesh, const std::string& file) {
  if (mesh.triangle.empty()) bad_input(file, "has no triangles");
  Found open, shared, against;
  const std::vector<Edge> edges = edges_of(mesh);
  for (std::size_t k = 0, end = 0; k < edges.size(); k = end) {
    std::size_t up = 0;
    for (end = k; end < edges.size() && edges[end].same(edges[k]); ++end) up += edges[end].up;
    const std::size_t all = end - k;
    if (all == 1)
      open.add(edges[k]);
    else if (all > 2)
      shared.add(edges[k]);
    else if (up != 1)
      against.add(edges[k]);
  }
  if (open.count > 0)
    bad_input(file, fmt::format("is not closed: {} edge{} a triangle on one side only: {}; close "
                                "the surface, because a solid has an inside",
                                open.count, open.count == 1 ? " has" : "s have", open.text(mesh)));
  if (shared.count > 0)
    bad_input(file, fmt::format("touches itself: {} edge{} to more than two triangles: {}; part "
                                "the bodies there, or unite them",
                                shared.count, shared.count == 1 ? " belongs" : "s belong",
                                shared.text(mesh)));
  if (against.count > 0)
    bad_input(file, fmt::format("has triangles that do not agree about the inside: the two at {} "
                                "edge{} turn against each other: {}; make all of them "
                                "counterclockwise seen from outside",
                                against.count, against.count == 1 ? "" : "s", against.text(mesh)));
  const double volume = volume_of(mesh);
  if (volume < 0)
    bad_input(file, "is inside out: its triangles are clockwise seen from outside; flip them all");
  if (!(volume > 0)) bad_input(file, "encloses no volume");
}

}  // namespace pbf::scene_module
