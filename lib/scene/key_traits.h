// Properties of a key's numbers.
#pragma once

#include <cstddef>
#include <limits>

namespace pbf::scene_module {

/// Allowed values of every number of a key.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is not allowed
  bool below_max = false;  ///< max itself is not allowed
  bool operator==(const Range&) const = default;
};

// Bounds that only prevent overflow in float arithmetic: boxes from 1e-6 m to 1e6 m, up to a
// million box lengths from the origin.
inline constexpr Range kCoordinate{-1e12, 1e12};
inline constexpr Range kLength{1e-9, 1e9};
inline constexpr Range kSeconds{1e-12, 1e9};
inline constexpr Range kRate{-1e12, 1e12};

/// The y of a vector that is given by x and z only (`dimensions: 2`).
enum class FlatY {
  none,    ///< three numbers are required
  bottom,  ///< defines the lower y of the domain: 0
  top,     ///< defines its upper y: a spacing above the lower
  low,     ///< the domain's lower y
  high,    ///< the domain's upper y
  middle,  ///< the plane
  zero,
};

}  // namespace pbf::scene_module
