// A solid in the domain as plain data.
#pragma once

#include <optional>
#include <string>

#include "kernels/shapes/shapes.h"
#include "lib/scene/free_body.h"
#include "lib/scene/kinds.h"
#include "lib/scene/motion.h"

// clang-format off
#define PBF_SHAPE_FILE(name) PBF_SHAPE_TEXT(lib/scene/shapes/name.h)
// clang-format on
#include "kernels/shapes/list.h"
#include "lib/scene/shapes/heights.h"

namespace pbf::scene_module {

namespace obstacle_keys {
/// The keys of a shape, in the order of the list, and of those that become one of the list.
using Any = std::variant<PBF_SHAPES, Heights>;
}  // namespace obstacle_keys

struct Obstacle {
  std::string name;
  obstacle_keys::Any shape = obstacle_keys::Box{};
  bool loads = false;            ///< the fluid's force on it is recorded
  double friction = 0;           ///< 0 (free slip) to 1 (no slip)
  std::optional<Motion> motion;  ///< prescribed
  std::optional<FreeBody> free;  ///< the fluid moves it; without both, it is fixed
  bool operator==(const Obstacle&) const = default;

  bool moves() const { return motion || free; }
  /// Whether the fluid may move a solid of its shape.
  bool may_be_free() const {
    return std::visit(
        [](const auto& keys) {
          return requires { keys.moments(false); };
        },
        shape);
  }
  /// The keys of its shape, which must be `Shape`.
  template <class Shape>
  Shape& as() {
    return std::get<Shape>(shape);
  }
  template <class Shape>
  const Shape& as() const {
    return std::get<Shape>(shape);
  }
  /// Where its surface comes from; null if its keys say all.
  obstacle_keys::SurfaceFile* surface_file() {
    return std::visit(
        [](auto& keys) -> obstacle_keys::SurfaceFile* {
          if constexpr (requires { keys.surface; }) return &keys;
          return nullptr;
        },
        shape);
  }
  const obstacle_keys::SurfaceFile* surface_file() const {
    return const_cast<Obstacle*>(this)->surface_file();
  }
  /// m per unit of that file.
  double meters() const {
    return std::visit(
        [](const auto& keys) {
          if constexpr (requires { keys.meters(); }) return keys.meters();
          return 1.0;
        },
        shape);
  }
  /// Its position in the scene, m: the center of a body, or a point of a plane.
  Double3 middle() const {
    return std::visit([](const auto& keys) { return keys.middle(); }, shape);
  }
  /// The axes of its body as rows.
  Matrix3 axes() const {
    return std::visit([](const auto& keys) { return keys.axes(); }, shape);
  }
};

}  // namespace pbf::scene_module
