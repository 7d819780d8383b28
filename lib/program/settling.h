// The start that settles before time 0, as a scene of its own.
#pragma once

#include <cstdint>

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// Velocities fall by exp(-kSettlingDamping) while the start settles, a wave by the root of that:
/// to 0.7 %.
inline constexpr double kSettlingDamping = 10;

/// The scene in which the start settles: damped, in a tank that stands, with obstacles where they
/// are when the run begins. Without output, gauges, loads and guard. Its step is constant: with
/// time.adaptive the longest that this allows for gravity. Needs scene.settle.
Scene settling_scene(const Scene& scene);

/// Its updates; 0 without scene.settle.
std::int64_t settling_updates(const Scene& scene);

}  // namespace pbf::program_module
