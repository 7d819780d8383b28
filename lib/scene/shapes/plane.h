// A plane: the half space behind it is solid.
#pragma once

#include "lib/scene/shapes/keys.h"

namespace pbf::scene_module {
namespace obstacle_keys {

struct Plane {
  static constexpr const char* word = "plane";
  using Body = shape::Plane<double>;
  Double3 point{};          ///< m, of the surface
  Double3 normal{0, 0, 1};  ///< points out of the solid
  bool operator==(const Plane&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Plane::point, "point", "m", kCoordinate, "A point of the plane's face.", true,
                FlatY::middle},
        KindKey{&Plane::normal, "normal", "", Range{-1e6, 1e6},
                "At right angles to the face, away from the solid.", true, FlatY::zero}};
  }
  void check(auto& rules) const {
    if (!rules.good(normal)) return;
    if (dot(normal, normal) == 0)
      rules.add(normal, "has no direction; give one away from the solid, [0, 0, 1] say");
    else if (rules.flat() && normal[1] != 0)
      rules.add(normal,
                "has a y component, with dimensions: 2 planes stand on the x-z plane; give "
                "0 for y");
  }
  Double3 middle() const { return point; }
  Matrix3 axes() const { return frame_along(normal); }
  Body make(double) const { return {}; }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
