// How high the fluid of a scene stands at the start, and how high when it has come to rest.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// Heights against gravity above the lowest place of the domain, m.
struct StartLevel {
  double top = 0, bottom = 0;  ///< of all bodies
  double rest = 0;             ///< of the surface at rest
  bool rests = true;           ///< all that is free below the top is fluid
};

/// From the boxes of the bodies, without those from files, and, for obstacles, from a grid of 24 x
/// 24 x 120 places. Obstacles from files count as fluid.
StartLevel start_level(const Scene& scene);

}  // namespace pbf::program_module
