// How much room the neighbour lists on the device have.
#pragma once

namespace pbf {

/// In words of 4 entries.
struct ListRoom {
  int first = 0;  ///< words every list has
  int tail = 0;   ///< words of one tail
  int tails = 0;  ///< tails in the pool
  constexpr int longest() const { return 4 * (first + tail); }
};

}  // namespace pbf
