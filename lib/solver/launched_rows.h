// For how many rows passes are launched where the number of particles changes.
#pragma once

#include <cstdint>
#include <string>

namespace pbf::solver_module {

/// The next multiple of an eighth of a power of two, so that there are at most eight different
/// launches, and recordings of them, until the number has doubled.
constexpr std::int64_t launched_rows(std::int64_t rows) {
  std::int64_t unit = 128;
  while (16 * unit < rows) unit *= 2;
  return (rows + unit - 1) / unit * unit;
}

/// Of particles for which there is no row.
inline std::string no_room_text(std::int64_t refused, std::int64_t capacity) {
  return std::to_string(refused) + " particles too many: there is memory for " +
         std::to_string(capacity) + " at a time";
}

}  // namespace pbf::solver_module
