// Quantities that color the particles of a picture, and the styles in which it shows the fluid.
// These tables are the only lists: keys, options, memory, downloads and pictures read them.
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

enum class RenderStyle { spheres, surface };

struct RenderStyleInfo {
  const char* word;     ///< in scenes and options
  int bytes_per_pixel;  ///< of its own buffers, in addition to samples and picture
};
/// In the order of the enum. Surface: two pairs of floats, depth, thickness and the scene below.
inline constexpr RenderStyleInfo kRenderStyles[] = {{"spheres", 0}, {"surface", 8 + 8 + 4 + 2 + 4}};

/// Texels of the shadow map along its longer side, 4 bytes each; not in two dimensions.
inline constexpr int kShadowTexels = 512;

constexpr const RenderStyleInfo& about(RenderStyle s) { return kRenderStyles[static_cast<int>(s)]; }
constexpr const auto& table_of(RenderStyle) { return kRenderStyles; }

}  // namespace pbf::scene_module
