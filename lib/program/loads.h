// Which walls of a scene have their loads summed.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::inline program_module {

inline bool has_loads(const Scene& scene) { return scene.domain.loads; }

/// The faces of the domain in the order of WallBit's bits, along the axes of the scene.
inline constexpr std::array<const char*, 6> kFaceNames = {"x_min", "x_max", "y_min",
                                                          "y_max", "z_min", "z_max"};

/// How many walls have sums; those of open faces stay 0.
inline std::int64_t load_walls(const Scene& scene) {
  return has_loads(scene) ? std::int64_t(kFaceNames.size()) : 0;
}

}  // namespace pbf::inline program_module
