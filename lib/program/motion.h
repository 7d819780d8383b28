// Prescribed motions as functions of time: positions of obstacles, and the effect of the tank's
// motion on the fluid. They have no state, so a run can resume or go back to an earlier time.
#pragma once

#include <array>
#include <vector>

#include "kernels/boundary/moving.h"
#include "kernels/boundary/obstacle.h"
#include "lib/program/axes.h"
#include "lib/program/free_bodies.h"
#include "lib/scene/periodic.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

/// The displacement of a body: x -> pivot + turn (x - pivot) + shift; m, along the scene's axes.
struct Pose {
  Matrix3 turn = kUnit3;
  Double3 pivot{}, shift{};
  Double3 of(const Double3& x) const;
};

/// How many obstacles have a prescribed motion.
std::int64_t prescribed_obstacles(const Scene& scene);
inline bool has_prescribed_obstacles(const Scene& scene) { return prescribed_obstacles(scene) > 0; }
/// Whether an obstacle or the tank has a prescribed motion.
inline bool has_prescribed_motion(const Scene& scene) {
  return scene.tank_motion || has_prescribed_obstacles(scene);
}
/// Whether an obstacle moves, prescribed or free.
inline bool has_moving_obstacles(const Scene& scene) {
  return has_prescribed_obstacles(scene) || has_free_bodies(scene);
}
/// Whether an obstacle or the tank moves.
inline bool has_motion(const Scene& scene) {
  return scene.tank_motion || has_moving_obstacles(scene);
}

/// Whether something does work on the fluid that its energy does not contain. Emission is apart.
inline bool has_work(const Scene& scene) { return has_motion(scene) || has_drive(scene); }

/// At `time` (s since the start); of a free body where it is now. Throws Error(internal) if the
/// file of the motion was not read.
Pose pose_of(const Scene& scene, const Obstacle& obstacle, double time);
/// m: largest distance of a point of the obstacle from its middle, at most the domain's diagonal.
double size_of(const Scene& scene, const Obstacle& obstacle);

/// Rotation of the tank about its axis, and its displacement (m).
struct TankPose {
  double angle = 0;  ///< radians
  Double3 shift{};
};
/// Needs scene.tank_motion. All 0 for a table of accelerations.
TankPose tank_pose(const Scene& scene, double time);

/// The effect of the tank's motion in a step of length `dt` from `time` on (s since the start), in
/// the internal frame. Without scene.tank_motion, gravity alone.
FrameStep<double> frame_step(const Scene& scene, const Axes& axes, double time, double dt);

/// m/s: upper bound of the speed of the points of moving obstacles within the domain, between two
/// times (s since the start). 0 if no obstacle moves. Of free bodies it is that of now: what moves
/// them is not known before.
double fastest_obstacle(const Scene& scene, double from, double to);
/// m/s^2: largest acceleration of a particle at rest, including gravity, between two times.
double greatest_pull(const Scene& scene, double from, double to);
/// m/s^2: largest difference of this acceleration from gravity, in the middle of the domain.
double greatest_sway(const Scene& scene, double from, double to);

}  // namespace pbf::program_module
