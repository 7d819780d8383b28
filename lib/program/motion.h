// Prescribed motions as functions of time: positions of obstacles, and the effect of the tank's
// motion on its fluid. Nothing is stored, so a run can continue or go back without extra state.
#pragma once

#include <array>
#include <vector>

#include "kernels/boundary/moving.h"
#include "kernels/boundary/obstacle.h"
#include "lib/program/axes.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// Where a body has gone: x -> pivot + turn (x - pivot) + shift, m, along the scene's axes.
struct Pose {
  Matrix3 turn = kUnit3;
  Double3 pivot{}, shift{};
  Double3 of(const Double3& x) const;
};

/// Whether an obstacle of the scene moves.
bool has_moving_obstacles(const Scene& scene);
/// Whether that or the tank does.
inline bool has_motion(const Scene& scene) {
  return scene.tank_motion || has_moving_obstacles(scene);
}

/// Of an obstacle at `time` (s since the start). Error(internal) for a file that was not read.
Pose pose_of(const Scene& scene, const Obstacle& obstacle, double time);
/// m: how far what it holds is from its middle at most, no more than the domain is long.
double size_of(const Scene& scene, const Obstacle& obstacle);

/// How the tank stands: turned about its axis, and how far it has gone (m).
struct TankPose {
  double angle = 0;  ///< radians
  Double3 shift{};
};
/// scene.tank_motion must be there. Of a table of accelerations all 0.
TankPose tank_pose(const Scene& scene, double time);

/// What the motion of the tank does within a step of `dt` from `time` on (s since the start), in
/// the internal frame. Unmoved without scene.tank_motion.
FrameStep<double> frame_step(const Scene& scene, const Axes& axes, double time, double dt);

/// m/s: how fast a place of a moving obstacle is at most, where it is in the domain, between two
/// times (s since the start). 0: nothing moves.
double fastest_obstacle(const Scene& scene, double from, double to);
/// m/s^2: what a particle at rest feels at most, gravity included, between two times.
double greatest_pull(const Scene& scene, double from, double to);
/// m/s^2: by how much that differs from gravity at most, in the middle of the domain.
double greatest_sway(const Scene& scene, double from, double to);

}  // namespace pbf::inline program_module
