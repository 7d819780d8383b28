#include "lib/render/mesh_surface.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pbf::render_module {
namespace {

constexpr double kSmooth = 0.819;  // cosine of 35 degrees

}  // namespace

std::vector<MeshTriangle> drawn_triangles(const SolidMesh& surface, double meters) {
  const TriangleMesh& mesh = surface.mesh();
  const std::size_t n = mesh.triangle.size();
  // Around each vertex: the triangles from first[v] to first[v + 1].
  std::vector<std::size_t> first(mesh.vertex.size() + 1), next;
  std::vector<std::int32_t> around(3 * n);
  for (const auto& t : mesh.triangle)
    for (const std::int32_t v : t) ++first[std::size_t(v) + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  next = first;
  std::vector<Double3> area(n), normal(n);
  for (std::size_t t = 0; t < n; ++t) {
    for (const std::int32_t v : mesh.triangle[t]) around[next[std::size_t(v)]++] = std::int32_t(t);
    area[t] = cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
    const double size = length(area[t]);
    normal[t] = size > 0 ? (1 / size) * area[t] : Double3{};
  }
  std::vector<MeshTriangle> out;
  for (std::size_t t = 0; t < n; ++t) {
    if (!(dot(normal[t], normal[t]) > 0)) continue;
    MeshTriangle& to = out.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = std::size_t(mesh.triangle[t][k]);
      const std::int32_t end = mesh.triangle[t][(k + 1) % 3];
      to.place[k] = meters * (mesh.vertex[v] - surface.middle());
      Double3 sum{};
      to.crease[k] = false;
      for (std::size_t i = first[v]; i < first[v + 1]; ++i) {
        const auto other = std::size_t(around[i]);
        const bool smooth = dot(normal[other], normal[t]) > kSmooth;
        if (smooth) sum = sum + area[other];
        const bool beyond = other != t && std::ranges::count(mesh.triangle[other], end) > 0;
        if (beyond && !smooth && dot(normal[other], normal[other]) > 0) to.crease[k] = true;
      }
      to.normal[k] = unit(sum);
    }
  }
  return out;
}

}  // namespace pbf::render_module
