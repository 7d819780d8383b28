// Boxes as meshes.
#pragma once

#include <cstdint>
#include <string>

#include "lib/scene/triangle_mesh.h"

namespace pbf::test {

/// Its triangles, counterclockwise seen from outside. The bits of a corner's number are x, y and z:
/// set at the upper end.
inline constexpr std::int32_t kBoxFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                  {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                  {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};

inline TriangleMesh box_mesh(const Double3& low, const Double3& high) {
  TriangleMesh m;
  for (int k = 0; k < 8; ++k)
    m.vertex.push_back(
        {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]});
  for (const auto& f : kBoxFaces) m.triangle.push_back({f[0], f[1], f[2]});
  return m;
}

/// The same from the origin on, as OBJ; without its last triangle if `open`.
inline std::string box_obj(const Double3& edges, bool open = false) {
  TriangleMesh m = box_mesh({0, 0, 0}, edges);
  if (open) m.triangle.pop_back();
  std::string text;
  for (const Double3& x : m.vertex)
    text += "v " + std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) +
            "\n";
  for (const auto& t : m.triangle)
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  return text;
}

}  // namespace pbf::test
