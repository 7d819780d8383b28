#include "lib/program/obstacle_poses.h"

#include "lib/program/motion.h"

namespace pbf::inline program_module {

std::vector<ObstaclePose> obstacle_poses(const Scene& scene, double time) {
  std::vector<ObstaclePose> all;
  for (const Obstacle& o : scene.obstacles) {
    if (!o.motion) continue;
    const Pose pose = pose_of(scene, o, time);
    all.push_back({o.name, pose.of(o.middle()), pose.turn});
  }
  return all;
}

}  // namespace pbf::inline program_module
