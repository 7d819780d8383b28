// The parts of a shape of obstacles in scenes. A shape is a struct with its keys as members (m) and
//   word                   its name in scenes
//   Body                   its type in the kernels
//   keys()                 its rows in the table of keys (KindKey), in the order of pages
//   check(rules)           checks rules between its keys, by SceneRules
//   middle(), axes()       position of the body, m, and its axes as rows
//   make(h)                the body, with lengths divided by h
// A shape that may be free, that is, moved by the fluid, also has (lib/scene/rigid.h)
//   moments(flat)          its volume, center and second moments
//   contacts(flat)         where it may touch something
// flat: in two dimensions, where check() has refused what they cannot describe.
#pragma once

#include <numbers>
#include <tuple>

#include "kernels/shapes/shapes.h"
#include "lib/base/text.h"
#include "lib/scene/kinds.h"
#include "lib/scene/rigid.h"
#include "lib/scene/vector3.h"

namespace pbf::scene_module {

namespace obstacle_keys {

inline constexpr const char* kRadiusHelp =
    "Radius; of cylinders, capsules and discs at least the smoothing length.";

inline constexpr const char* kTurnAxisHelp =
    "It is turned about this axis: a box through its middle, with dimensions: 2 about y; a mesh, "
    "after scaling, through the origin of its file.";
inline constexpr const char* kTurnAngleHelp =
    "By so much, counterclockwise seen from where the axis points.";

/// The fluid resolves curvature only down to the smoothing length.
void check_radius(auto& rules, const double& radius) {
  if (!rules.good_h(radius) || radius >= rules.h()) return;
  rules.add(radius,
            "is {}, below the smoothing length ({} m): the fluid could not see how the surface is "
            "curved; enlarge it or lower fluid.spacing to {}",
            radius, rules.h(), radius / rules.smoothing_ratio());
}

/// A body around an axis between two points.
struct Tube {
  Double3 from{}, to{};  ///< m, ends of the axis
  double radius = 0;     ///< m
  bool operator==(const Tube&) const = default;

  static auto keys_in(FlatY from, FlatY to) {
    return std::tuple{
        KindKey{&Tube::radius, "radius", "m", kLength, kRadiusHelp},
        KindKey{&Tube::from, "from", "m", kCoordinate, "One end of the axis.", true, from},
        KindKey{&Tube::to, "to", "m", kCoordinate, "The other end.", true, to}};
  }
  /// `flat`: the error of the axis with dimensions: 2; null: none.
  void check_axis(auto& rules, const char* flat) const {
    if (rules.good(from, to)) {
      if (from == to)
        rules.add(to, "is where the axis begins ({}); give the other end", rules.name(from));
      else if (flat)
        rules.add(to, "{}", flat);
    }
    check_radius(rules, radius);
  }
  Double3 middle() const { return 0.5 * from + 0.5 * to; }
  Double3 along() const { return to - from; }
  double length() const { return std::hypot(along()[0], along()[1], along()[2]); }
  Matrix3 axes() const { return frame_along(along()); }
};

}  // namespace obstacle_keys
}  // namespace pbf::scene_module
