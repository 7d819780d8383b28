// What a key says of its numbers.
#pragma once

#include <limits>

namespace pbf::inline scene_module {

/// Allowed values of every number of a key.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is not allowed
  bool below_max = false;  ///< max itself is not allowed
  bool operator==(const Range&) const = default;
};

// Bounds that hold off overflow in float arithmetic and nothing that anyone simulates: boxes from
// 1e-6 m to 1e6 m, up to a million box lengths from the origin.
inline constexpr Range kCoordinate{-1e12, 1e12};
inline constexpr Range kLength{1e-9, 1e9};
inline constexpr Range kSeconds{1e-12, 1e9};
inline constexpr Range kRate{-1e12, 1e12};

/// With `dimensions: 2` a vector may be given by x and z; what its y is then.
enum class FlatY {
  none,    ///< it needs three numbers
  bottom,  ///< that of the domain: 0 ...
  top,     ///< ... and a spacing above
  low,     ///< the domain's lower y
  high,    ///< the domain's upper y
  middle,  ///< the plane
  zero,
};

}  // namespace pbf::inline scene_module
