// Maps of bodies with a surface of triangles, for kernels/shapes/mesh.h.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kernels/shapes/mesh.h"
#include "lib/scene/triangle_mesh.h"

namespace pbf::program_module {

/// Owns what shape::Mesh refers to.
struct MeshMap {
  shape::Mesh<double> map;  ///< without addresses
  std::vector<int> brick;
  std::vector<Vec4<double>> shares;
  std::vector<double> away;
  /// Refers to this object, which must outlive it and stay where it is.
  shape::Mesh<double> at() const {
    shape::Mesh<double> m = map;
    m.brick = brick.data(), m.shares = shares.data(), m.away = away.data();
    return m;
  }
};

struct MapOptions {
  double range = 1;             ///< h, of the walls' density
  double reach = 1;             ///< h: so far from the surface the distance is exact
  Bounds<double> wanted{};      ///< body coordinates, h: the map may end there
  bool everywhere = true;       ///< instead: it ends where the surface does
  std::int64_t most = 1 << 30;  ///< nodes
  /// Called at times by one thread with the part that is done, 0 to 1.
  std::function<void(double)> progress{};
};
/// Of a closed mesh in body coordinates, h. Nodes are h/4 apart. The same bytes on any number of
/// threads. Where parts of a mesh overlap, shares add up to 1 at most. Throws Error(bad_input) if
/// it would have more nodes than `most`.
MeshMap make_mesh_map(const TriangleMesh& mesh, const MapOptions& options);

}  // namespace pbf::program_module
