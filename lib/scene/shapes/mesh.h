// A body with a surface of triangles, from a file.
#pragma once

#include <memory>
#include <string>

#include "lib/scene/shapes/keys.h"
#include "lib/scene/solid_mesh.h"

namespace pbf::scene_module {
namespace obstacle_keys {

/// What shapes have in common whose surface comes from a file. Equal if path and contents are.
struct SurfaceFile {
  using Body = shape::Mesh<double>;
  std::string path;                          ///< relative to the scene file
  Double3 translate{};                       ///< m
  Place place{};                             ///< of the path
  std::shared_ptr<const SolidMesh> surface;  ///< null until it is read

  bool operator==(const SurfaceFile& o) const {
    const auto contents = [](const SurfaceFile& f) {
      return f.surface ? f.surface->sha256() : std::string();
    };
    return path == o.path && translate == o.translate && contents(*this) == contents(o);
  }
  static auto keys_of(const char* path_help) {
    return std::tuple{KindKey{&SurfaceFile::path, "path", "", Range{}, path_help, true, FlatY::none,
                              false, 0, true},
                      KindKey{&SurfaceFile::translate, "translate", "m", kCoordinate,
                              "By so much it is then moved.", false, FlatY::zero}};
  }
  static constexpr const char* kPathHelp =
      "File with its surface, relative to the scene file. Of a mesh: STL, binary or ASCII, or OBJ; "
      "closed. Of heights: CSV with the header x,y,z, in m, one row for each point of a grid along "
      "x and y that covers the domain; what is below is solid.";
  void check(auto& rules) const {
    if (rules.flat())
      rules.add(path,
                "a surface from a file has no section for dimensions: 2; give boxes, "
                "cylinders or planes, or three dimensions");
    else if (rules.paper())
      rules.add(path,
                "is made for kernels: consistent alone; remove `kernels: paper`, or give "
                "boxes, cylinders or planes");
  }
  /// Its box, without the map (lib/program/obstacles.h). meters: of a unit of the file.
  Body bare(double meters, double h) const {
    Body body;
    if (!surface) return body;
    const auto [low, high] = box_of(surface->mesh());
    const Double3 from = (meters / h) * (low - surface->middle()),
                  to = (meters / h) * (high - surface->middle());
    body.box = {{from[0], from[1], from[2]}, {to[0], to[1], to[2]}};
    return body;
  }
};

struct Mesh : SurfaceFile {
  static constexpr const char* word = "mesh";
  double scale = 1;            ///< m per unit of the file
  Double3 turn_axis{0, 0, 1};  ///< through the origin of the file
  double turn_angle = 0;       ///< degrees, by the right-hand rule
  bool operator==(const Mesh&) const = default;

  static auto keys() {
    return std::tuple_cat(
        keys_of(kPathHelp),
        std::tuple{
            KindKey{&Mesh::scale, "scale", "", Range{1e-12, 1e12},
                    "Meters per unit of the mesh's coordinates; 0.001 for millimeters.", false},
            KindKey{&Mesh::turn_axis, "turn_axis", "", Range{-1e6, 1e6}, kTurnAxisHelp, false},
            KindKey{&Mesh::turn_angle, "turn_angle", "degrees", Range{-360, 360}, kTurnAngleHelp,
                    false}});
  }
  void check(auto& rules) const {
    SurfaceFile::check(rules);
    if (rules.good(turn_axis) && dot(turn_axis, turn_axis) == 0)
      rules.add(turn_axis, "has no direction; give one, [0, 0, 1] say");
  }
  Double3 middle() const {
    if (!surface) return translate;
    const Double3 m = scale * surface->middle();
    const Matrix3 rows = axes();
    return m[0] * rows[0] + m[1] * rows[1] + m[2] * rows[2] + translate;
  }
  Matrix3 axes() const { return axes_turned(turn_axis, turn_angle); }
  double meters() const { return scale; }
  Body make(double h) const { return bare(scale, h); }
  /// Zeros, or no places, until the surface is read. Made once: every measurement asks for them.
  BodyMoments moments(bool) const {
    if (!surface) return {};
    BodyMoments m = surface->derived<BodyMoments>(
        {}, [&] { return moments_of(surface->mesh(), surface->middle()); });
    const double cube = scale * scale * scale;
    m.volume *= cube;
    m.center = scale * m.center;
    for (Double3& row : m.second) row = (cube * scale * scale) * row;
    return m;
  }
  std::vector<ContactPoint> contacts(bool) const {
    if (!surface) return {};
    return surface->derived<std::vector<ContactPoint>>({scale}, [&] {
      return contacts_of(surface->mesh(), surface->middle(), scale, kMeshContacts);
    });
  }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
