// The shapes of obstacles: of scenes, and in the kernels.
#pragma once

namespace pbf {

enum class ObstacleShape : int { plane, box, sphere, cylinder, capsule };

}  // namespace pbf
