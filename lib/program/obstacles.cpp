#include "lib/program/obstacles.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernels/boundary/near_rows.h"
#include "lib/base/error.h"
#include "lib/base/machine.h"
#include "lib/program/calibrate.h"
#include "lib/program/mesh_map.h"
#include "lib/program/motion.h"
#include "lib/scene/vector3.h"

namespace pbf::program_module {
namespace {

/// Bits of the body's ends that lie on or behind walls. `ends`: half lengths in m; 0: no end.
unsigned behind_walls(const Scene& s, const Matrix3& rows, const Double3& center,
                      const Vec3<double>& ends) {
  const double half[3] = {ends.x, ends.y, ends.z};
  unsigned through = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::fabs(rows[axis][k]) < 1) continue;  // not along coordinate k
      for (const int side : {-1, 1}) {
        const unsigned bit = (side < 0 ? 1u : 2u) << (2 * axis);
        const double along = side * rows[axis][k], at = center[k] + along * half[axis];
        const double slack = 1e-9 * (s.domain.max[k] - s.domain.min[k]);
        const bool reached =
            along < 0 ? at <= s.domain.min[k] + slack : at >= s.domain.max[k] - slack;
        if (half[axis] > 0 && reached && s.domain.has_wall(int(k), along > 0)) through |= bit;
      }
    }
  return through;
}

/// The part of the body's space, h, that is in the domain; without end beyond open faces.
Bounds<double> wanted_of(const Scene& s, const Matrix3& rows, const Double3& center) {
  Bounds<double> out{{kEndless, kEndless, kEndless}, {-kEndless, -kEndless, -kEndless}};
  for (unsigned corner = 0; corner < 8; ++corner) {
    Double3 x{};
    for (std::size_t a = 0; a < 3; ++a)
      x[a] = (corner >> a & 1 ? s.domain.max : s.domain.min)[a] - center[a];
    const Vec3<double> at =
        (1 / s.h()) * Vec3<double>{dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)};
    out = {{std::min(out.low.x, at.x), std::min(out.low.y, at.y), std::min(out.low.z, at.z)},
           {std::max(out.high.x, at.x), std::max(out.high.y, at.y), std::max(out.high.z, at.z)}};
  }
  return out;
}

/// Of a node on the host, in double and in the precision of the run.
constexpr std::int64_t kNodeBytes = 80;

/// The map of a surface that has been read, made when it is first asked for.
shape::Mesh<double> map_of(const Obstacle& o, const Scene& s, const Matrix3& rows,
                           const Double3& center, const MapProgress& progress) {
  const SolidMesh& surface = *o.surface_file()->surface;
  MapOptions options;
  options.range = wall_range(s);
  options.reach = options.range + kNearRoom;
  options.everywhere = o.moves() || !s.domain.open.empty();
  if (!options.everywhere) options.wanted = wanted_of(s, rows, center);
  options.progress = progress;
  options.most =
      std::min<std::int64_t>(options.most, std::int64_t(available_memory()) / kNodeBytes);
  const double by = o.meters() / s.h();
  const auto& [low, high] = options.wanted;
  const std::vector<double> numbers{
      by, options.range, double(options.everywhere), low.x, low.y, low.z, high.x, high.y, high.z};
  const MeshMap& map = surface.derived<MeshMap>(numbers, [&] {
    TriangleMesh mesh = surface.mesh();
    for (Double3& x : mesh.vertex) x = by * (x - surface.middle());
    return make_mesh_map(mesh, options);
  });
  return map.at();
}

Solid<double> solid_of(const Obstacle& o, const Scene& s, double time,
                       const MapProgress& progress = {}) {
  Matrix3 rows = o.axes();
  Double3 center = o.middle();
  if (o.moves()) {
    const Pose pose = pose_of(s, o, time);
    center = pose.of(center);
    for (Double3& axis : rows) axis = times(pose.turn, axis);
  }
  if (s.plane()) center[1] = *s.plane();  // two dimensions ignore y
  const double h = s.h();
  const Double3 from = s.origin();
  Solid<double> out;
  out.shape = std::visit(
      [&](const auto& keys) -> SomeShape<double> {
        if constexpr (requires { keys.surface; })
          if (keys.surface) return map_of(o, s, rows, center, progress);
        auto body = keys.make(h);
        if constexpr (requires { body.through; })
          if (!o.free) body.through = behind_walls(s, rows, center, keys.make(1).ends());
        return body;
      },
      o.shape);
  out.center = {(center[0] - from[0]) / h, (center[1] - from[1]) / h, (center[2] - from[2]) / h};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k) out.turn[r][k] = rows[r][k];
  return out;
}

}  // namespace

std::vector<Solid<double>> solids_of(const Scene& scene, double time) {
  std::vector<Solid<double>> all;
  for (const Obstacle& o : scene.obstacles) all.push_back(solid_of(o, scene, time));
  return all;
}

void make_maps(const Scene& scene, const ObstacleProgress& progress) {
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
    const Obstacle& o = scene.obstacles[k];
    if (!o.surface_file()) continue;
    try {
      solid_of(o, scene, 0, [&](double done) {
        if (progress) progress(k, done);
      });
    } catch (const Error& e) {
      const std::string& place = o.surface_file()->place.text;
      throw Error(e.code(), (place.empty() ? "" : place + ": ") + "obstacles[" + std::to_string(k) +
                                "].path: its map " + e.what());
    }
  }
}

std::vector<Solid<double>> solids_of(const Scene& scene, const Axes& axes, double time) {
  std::vector<Solid<double>> all = solids_of(scene, time);
  turn_to_internal(axes, all);
  return all;
}

void turn_to_internal(const Axes& axes, std::vector<Solid<double>>& solids) {
  for (Solid<double>& s : solids) {
    s.center = along_internal(axes, {s.center.x, s.center.y, s.center.z});
    for (auto& row : s.turn) {
      const Vec3<double> to = along_internal(axes, {row[0], row[1], row[2]});
      row[0] = to.x, row[1] = to.y, row[2] = to.z;
    }
  }
}

}  // namespace pbf::program_module
