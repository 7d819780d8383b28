// Colours of values.
#pragma once

#include <array>
#include <cstdint>

#include "lib/scene/coloring.h"

namespace pbf::render_module {

using Rgb = std::array<std::uint8_t, 3>;

/// Colour of particles whose value is not a number: outside of the map, so that it is seen.
inline constexpr Rgb kNoValue{230, 0, 120};

/// Viridis: dark violet at t = 0 to yellow at 1; clamped outside, kNoValue for NaN.
Rgb viridis(double t);

/// Blue at t = 0 over white in the middle to red at 1; else as viridis.
Rgb blue_to_red(double t);

/// The map of a colouring: about a middle for density, else from low to high.
using ColorMap = Rgb (*)(double);
inline ColorMap color_map(ColorBy color) {
  return color == ColorBy::density ? blue_to_red : viridis;
}

}  // namespace pbf::render_module
