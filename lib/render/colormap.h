// Colours of values.
#pragma once

#include <array>
#include <cstdint>

namespace pbf::inline render_module {

using Rgb = std::array<std::uint8_t, 3>;

/// Colour of particles whose value is not a number: outside of the map, so that it is seen.
inline constexpr Rgb kNoValue{230, 0, 120};

/// Viridis: dark violet at t = 0 to yellow at 1; clamped outside, kNoValue for NaN.
Rgb viridis(double t);

}  // namespace pbf::inline render_module
