// A box, which may be rotated.
#pragma once

#include "lib/scene/shapes/keys.h"

namespace pbf::scene_module {
namespace obstacle_keys {

struct Box {
  static constexpr const char* word = "box";
  using Body = shape::Box<double>;
  Double3 min{}, max{};        ///< m, before the rotation
  Double3 turn_axis{0, 0, 1};  ///< axis of rotation through its center
  double turn_angle = 0;       ///< degrees, by the right-hand rule
  bool operator==(const Box&) const = default;

  static auto keys() {
    return std::tuple{
        KindKey{&Box::min, "min", "m", kCoordinate,
                "Lower corner of the box before it is turned. In place of min and max the box may "
                "have center, its middle, and size, its edges.",
                true, FlatY::low, true},
        KindKey{&Box::max, "max", "m", kCoordinate, "Upper corner of the box before it is turned.",
                true, FlatY::high, true},
        KindKey{&Box::turn_axis, "turn_axis", "", Range{-1e6, 1e6}, kTurnAxisHelp, false},
        KindKey{&Box::turn_angle, "turn_angle", "degrees", Range{-360, 360}, kTurnAngleHelp,
                false}};
  }
  void check(auto& rules) const {
    if (rules.good(min, max) && rules.above(min, max)) {
      const Double3 edge = max - min;
      const double flat = std::min(edge[0], edge[2]);
      rules.check_thickness(max, rules.flat() ? flat : std::min(flat, edge[1]));
    }
    if (rules.good(turn_axis) && dot(turn_axis, turn_axis) == 0)
      rules.add(turn_axis, "has no direction; give one, [0, 1, 0] say");
    else if (rules.good(turn_axis, turn_angle) && rules.flat() && turn_angle != 0 &&
             (turn_axis[0] != 0 || turn_axis[2] != 0))
      rules.add(turn_axis, "with dimensions: 2 a box can only be turned about y; give [0, 1, 0]");
  }
  Double3 middle() const { return 0.5 * min + 0.5 * max; }
  Matrix3 axes() const { return axes_turned(turn_axis, turn_angle); }
  Body make(double h) const {
    const Double3 half = 0.5 * (max - min);
    return {{half[0] / h, half[1] / h, half[2] / h}};
  }
  /// In two dimensions a rectangle.
  BodyMoments moments(bool flat) const {
    const Double3 e = max - min;
    return symmetric_moments(e[0] * (flat ? 1 : e[1]) * e[2],
                             {e[0] * e[0] / 12, flat ? 0 : e[1] * e[1] / 12, e[2] * e[2] / 12});
  }
  /// Corners, and middles of edges and faces.
  std::vector<ContactPoint> contacts(bool flat) const {
    const Double3 half = 0.5 * (max - min);
    std::vector<ContactPoint> all;
    for (int code = 0; code < 27; ++code) {
      const int x = code % 3 - 1, y = code / 3 % 3 - 1, z = code / 9 - 1;
      if (code != 13 && (!flat || y == 0)) all.push_back({{x * half[0], y * half[1], z * half[2]}});
    }
    return all;
  }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
