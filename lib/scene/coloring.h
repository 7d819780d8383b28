// Quantities that color the particles of a picture. This table is the only list: keys, options,
// memory, downloads and pictures read it.
#pragma once

#include "lib/scene/backend.h"

namespace pbf::scene_module {

enum class ColorBy { speed, density, compression, id };

struct ColoringInfo {
  const char* word;   ///< in scenes and options, and above the color bar
  const char* field;  ///< of a snapshot, which it reads
  int components;     ///< of the field: 3 for the length of a vector
};
/// In the order of the enum.
inline constexpr ColoringInfo kColorings[] = {{"speed", "velocity", 3},
                                              {"density", "density", 1},
                                              {"compression", "density", 1},
                                              {"id", "id", 1}};

constexpr const ColoringInfo& about(ColorBy c) { return kColorings[static_cast<int>(c)]; }
constexpr const auto& table_of(ColorBy) { return kColorings; }

}  // namespace pbf::scene_module
