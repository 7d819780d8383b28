// A solid in the domain as plain data.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "kernels/shapes/shapes.h"
#include "lib/scene/motion.h"

// clang-format off
#define PBF_SHAPE_FILE(name) PBF_SHAPE_TEXT(lib/scene/shapes/name.h)
// clang-format on
#include "kernels/shapes/list.h"

namespace pbf::inline scene_module {

namespace obstacle_keys {
/// The keys of a shape, in the order of the list.
using Any = std::variant<PBF_SHAPES>;
}  // namespace obstacle_keys

struct Obstacle {
  std::string name;
  obstacle_keys::Any shape = obstacle_keys::Box{};
  bool loads = false;            ///< the fluid's force on it is recorded
  std::optional<Motion> motion;  ///< absent: it is fixed
  bool operator==(const Obstacle&) const = default;

  /// The keys of its shape, which must be `Shape`.
  template <class Shape>
  Shape& as() {
    return std::get<Shape>(shape);
  }
  template <class Shape>
  const Shape& as() const {
    return std::get<Shape>(shape);
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

/// The address that stands for the key `shape` in names of keys. It is not that of the variant,
/// which is also the address of a key of the shape.
inline const void* address_of_word(const obstacle_keys::Any& shape) {
  return reinterpret_cast<const char*>(&shape) + 1;
}

/// Calls f with the keys of each shape, all defaults, in the order of the list.
template <class F>
void for_each_shape(F&& f) {
  [&]<class... Shape>(const std::variant<Shape...>*) {
    (f(Shape{}), ...);
  }(static_cast<const obstacle_keys::Any*>(nullptr));
}

}  // namespace pbf::inline scene_module
