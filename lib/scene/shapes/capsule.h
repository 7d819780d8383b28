// A capsule: all points within a radius of a line segment.
#pragma once

#include "lib/scene/shapes/keys.h"

namespace pbf::scene_module {
namespace obstacle_keys {

struct Capsule : Tube {
  static constexpr const char* word = "capsule";
  using Body = shape::Capsule<double>;
  bool operator==(const Capsule&) const = default;

  /// In two dimensions its axis lies in the plane.
  static auto keys() { return keys_in(FlatY::middle, FlatY::middle); }
  void check(auto& rules) const {
    check_axis(rules, rules.flat() && from[1] != to[1]
                          ? "with dimensions: 2 a capsule lies in the x-z plane; give both ends "
                            "the same y"
                          : nullptr);
  }
  Body make(double h) const { return {radius / h, 0.5 * length() / h}; }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
