// Which axes of the scene the internal ones are.
#pragma once

namespace pbf {

/// Internal x, y, z are the scene's axes of[0], of[1], of[2]: component k of a vector inside is
/// component of[k] of the same vector outside. Everything above the Solver interface is in scene
/// axes.
struct Axes {
  int of[3] = {0, 1, 2};

  /// The internal axis that the scene's axis is.
  constexpr int inside(int scene_axis) const {
    return of[0] == scene_axis ? 0 : of[1] == scene_axis ? 1 : 2;
  }
  /// -1 where two axes change places, which turns a right hand into a left one: the sign of what a
  /// cross product gives.
  constexpr int handedness() const { return (of[1] - of[0] + 3) % 3 == 1 ? 1 : -1; }
  constexpr bool operator==(const Axes&) const = default;
};

}  // namespace pbf
