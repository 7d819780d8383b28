// Mapping between the internal axes and the axes of the scene.
#pragma once

namespace pbf {

/// Internal x, y, z are the scene's axes of[0], of[1], of[2]: component k of an internal vector is
/// component of[k] of the same vector in the scene. Everything above the Solver interface uses
/// scene axes.
struct Axes {
  int of[3] = {0, 1, 2};

  /// The internal axis of an axis of the scene.
  constexpr int inside(int scene_axis) const {
    return of[0] == scene_axis ? 0 : of[1] == scene_axis ? 1 : 2;
  }
  /// -1 if the permutation is odd: the internal frame is then left-handed, and cross products
  /// change sign.
  constexpr int handedness() const { return (of[1] - of[0] + 3) % 3 == 1 ? 1 : -1; }
  constexpr bool operator==(const Axes&) const = default;
};

}  // namespace pbf
