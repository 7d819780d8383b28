// The styles in which a picture shows the fluid. This table is the only list.
#pragma once

#include "lib/scene/backend.h"

namespace pbf::scene_module {

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
