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
  /// In two dimensions its axis lies in the section.
  BodyMoments moments(bool flat) const {
    const double r2 = radius * radius, l = length(), half = 0.5 * l;
    // The ends together are a ball (a disc) whose halves are moved apart by half each.
    const double tube = (flat ? 2 * radius : std::numbers::pi * r2) * l,
                 ends = (flat ? std::numbers::pi : 4.0 / 3 * std::numbers::pi * radius) * r2,
                 middle = (flat ? 4 / (3 * std::numbers::pi) : 3.0 / 8) * radius,
                 own = r2 / (flat ? 4 : 5);
    const double across = tube * r2 / (flat ? 3 : 4) + ends * own,
                 along = tube * l * l / 12 + ends * (own + half * half + 2 * half * middle);
    BodyMoments m;
    m.volume = tube + ends;
    m.second[0][0] = across, m.second[2][2] = along;
    if (!flat) m.second[1][1] = across;
    return m;
  }
  std::vector<ContactPoint> contacts(bool) const {
    const double half = 0.5 * length();
    return {{{0, 0, -half}, radius}, {{0, 0, half}, radius}, {{}, radius}};
  }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
