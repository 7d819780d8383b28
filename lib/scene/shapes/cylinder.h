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
  /// In two dimensions a disc.
  BodyMoments moments(bool flat) const {
    const double r2 = radius * radius, l = length();
    return symmetric_moments(std::numbers::pi * r2 * (flat ? 1 : l),
                             {r2 / 4, r2 / 4, flat ? 0 : l * l / 12});
  }
  /// Points of both rims and of the circle between them, and the middles of the ends.
  std::vector<ContactPoint> contacts(bool flat) const {
    if (flat) return {{{}, radius}};
    const double half = 0.5 * length();
    std::vector<ContactPoint> all{{{0, 0, -half}}, {{0, 0, half}}};
    for (int k = 0; k < 16; ++k) {
      const double angle = std::numbers::pi * k / 8, x = radius * std::cos(angle),
                   y = radius * std::sin(angle);
      all.push_back({{x, y, -half}});
      all.push_back({{x, y, half}});
      if (k % 2 == 0) all.push_back({{x, y, 0}});
    }
    return all;
  }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
