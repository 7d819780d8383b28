// Meshes, STL and OBJ: any bytes give a mesh of finite vertices or an Error; a closed one has
// points inside its box, and a map of finite numbers with shares from 0 to 1.
#include <cmath>
#include <cstdlib>

#include "lib/base/error.h"
#include "lib/io/mesh_file.h"
#include "lib/program/mesh_map.h"

using namespace pbf;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// As an obstacle 1 h long.
void check_map(TriangleMesh m, const Double3& middle, double longest) {
  for (auto& x : m.vertex) x = (1 / longest) * (x - middle);
  const MeshMap map = make_mesh_map(m, {.range = 0.5, .reach = 0.5});
  for (const auto& s : map.shares)
    require(s.w >= 0 && s.w <= 1 && std::isfinite(s.x) && std::isfinite(s.y) && std::isfinite(s.z));
  for (const double away : map.away) require(std::isfinite(away));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const TriangleMesh m =
        read_mesh(std::string(reinterpret_cast<const char*>(data), size), "mesh");
    for (const auto& x : m.vertex)
      for (const double value : x) require(std::isfinite(value));
    for (const auto& t : m.triangle)
      for (const int v : t) require(v >= 0 && std::size_t(v) < m.vertex.size());
    require_closed(m, "mesh");
    const auto [low, high] = box_of(m);
    double longest = 0;
    for (std::size_t a = 0; a < 3; ++a) longest = std::fmax(longest, high[a] - low[a]);
    for (const auto& x : points_in(m, longest / 10, {}))
      for (std::size_t a = 0; a < 3; ++a) require(x[a] >= low[a] && x[a] <= high[a]);
    // In two dimensions the plane cuts it, however long it is along y.
    if (const double wide = std::fmax(high[0] - low[0], high[2] - low[2]); wide > 0)
      for (const auto& x : points_in(m, wide / 10, 0.5 * (low[1] + high[1])))
        for (std::size_t a = 0; a < 3; a += 2) require(x[a] >= low[a] && x[a] <= high[a]);
    // Keys of scenes give solids such lengths, in m; more triangles take too long here.
    if (longest > 1e-12 && longest < 1e12 && m.triangle.size() <= 48)
      check_map(m, low + 0.5 * (high - low), longest);
  } catch (const Error&) {
  }
  return 0;
}
