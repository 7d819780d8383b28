// A sphere.
#pragma once

#include "lib/scene/shapes/keys.h"

namespace pbf::scene_module {
namespace obstacle_keys {

struct Sphere {
  static constexpr const char* word = "sphere";
  using Body = shape::Sphere<double>;
  Double3 center{};   ///< m
  double radius = 0;  ///< m
  bool operator==(const Sphere&) const = default;

  static auto keys() {
    return std::tuple{KindKey{&Sphere::center, "center", "m", kCoordinate, "Centre of the sphere.",
                              true, FlatY::middle},
                      KindKey{&Sphere::radius, "radius", "m", kLength, kRadiusHelp}};
  }
  void check(auto& rules) const {
    if (rules.flat()) check_radius(rules, radius);
  }
  Double3 middle() const { return center; }
  Matrix3 axes() const { return kUnit3; }
  Body make(double h) const { return {radius / h}; }
  BodyMoments moments(bool flat) const {
    const double r2 = radius * radius;
    if (flat) return symmetric_moments(std::numbers::pi * r2, {r2 / 4, 0, r2 / 4});
    return symmetric_moments(4.0 / 3 * std::numbers::pi * r2 * radius, {r2 / 5, r2 / 5, r2 / 5});
  }
  std::vector<ContactPoint> contacts(bool) const { return {{{}, radius}}; }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
