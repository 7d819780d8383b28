// Meshes, STL and OBJ: any bytes give a mesh of finite vertices or an Error; a closed one has
// points inside its box.
#include <cmath>
#include <cstdlib>

#include "lib/base/error.h"
#include "lib/io/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const pbf::TriangleMesh m =
        pbf::read_mesh(std::string(reinterpret_cast<const char*>(data), size), "mesh");
    for (const auto& x : m.vertex)
      for (const double value : x)
        if (!std::isfinite(value)) std::abort();
    for (const auto& t : m.triangle)
      for (const int v : t)
        if (v < 0 || std::size_t(v) >= m.vertex.size()) std::abort();
    pbf::require_closed(m, "mesh");
    const auto [low, high] = pbf::box_of(m);
    double longest = 0;
    for (std::size_t a = 0; a < 3; ++a) longest = std::fmax(longest, high[a] - low[a]);
    for (const auto& x : pbf::points_in(m, longest / 10, {}))
      for (std::size_t a = 0; a < 3; ++a)
        if (!(x[a] >= low[a] && x[a] <= high[a])) std::abort();
  } catch (const pbf::Error&) {
  }
  return 0;
}
