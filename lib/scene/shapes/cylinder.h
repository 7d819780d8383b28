// A cylinder.
#pragma once

#include "lib/scene/shapes/keys.h"

namespace pbf::scene_module {
namespace obstacle_keys {

struct Cylinder : Tube {
  static constexpr const char* word = "cylinder";
  using Body = shape::Cylinder<double>;
  bool operator==(const Cylinder&) const = default;

  static auto keys() { return keys_in(FlatY::low, FlatY::high); }
  void check(auto& rules) const {
    if (rules.good(from, to) && from != to && !rules.flat()) rules.check_thickness(to, length());
    check_axis(rules, rules.flat() && (from[0] != to[0] || from[2] != to[2])
                          ? "with dimensions: 2 a cylinder stands on the x-z plane, which makes a "
                            "disc of it; give both ends the same x and z, or a box"
                          : nullptr);
  }
  Body make(double h) const { return {radius / h, 0.5 * length() / h}; }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
