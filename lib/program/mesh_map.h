// Maps of bodies with a surface of triangles, for kernels/shapes/map.h.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shapes/map.h"
#include "lib/scene/triangle_mesh.h"

namespace pbf::program_module {

/// Owns what shape::Map refers to.
struct MeshMap {
  shape::Map<double> map;  ///< without addresses
  std::vector<int> brick;
  std::vector<Vec4<double>> shares;
  std::vector<double> away;
  /// Refers to this object, which must outlive it and stay where it is.
  shape::Map<double> at() const {
    shape::Map<double> m = map;
    m.brick = brick.data(), m.shares = shares.data(), m.away = away.data();
    return m;
  }
};

/// Of a closed mesh in body coordinates, h. range: of the walls' density, h. reach: how far from
/// the surface the distance must be exact, h. Nodes are h/4 apart. The same bytes on any number of
/// threads.
MeshMap make_mesh_map(const TriangleMesh& mesh, double range, double reach);

}  // namespace pbf::program_module
