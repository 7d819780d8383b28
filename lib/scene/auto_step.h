// Computes the time step for `time.step: auto`.
#pragma once

#include <string>

#include "lib/scene/scene.h"

namespace pbf::inline scene_module {

/// s, the longest step of the rules, before it is fitted to the frames.
struct StepRule {
  double gravity;  ///< kSafeStep sqrt(h/g); infinite without gravity
  double speed;    ///< that moves the fastest body by kSafeWay h; infinite where all rest
  double longest() const { return gravity < speed ? gravity : speed; }
};

/// dt sqrt(g/h): the mean compression of a pool of 12 layers stays below 0.1 % with 4 iterations
/// (configs/README.md).
inline constexpr double kSafeStep = 0.03;
/// dt sqrt(|g|/h), time.step without dimension; 0 without gravity. In one update fluid at rest
/// falls by its square in h: it decides how far a pool is compressed, whatever its size.
double relative_step(const Scene& scene);
/// Way of a body in a step, in h: fluid that moves past other fluid by 0.4 h may pass through it
/// (kernels/relative_motion.h), and what falls gains speed.
inline constexpr double kSafeWay = 0.2;

StepRule step_rule(const Scene& scene);

/// s: the longest up to `longest` of which output.every is a whole number; without output with two
/// digits. A run may be made longer with --resume: time.end has no say. 0: `longest` is infinite.
double fitted_step(const Scene& scene, double longest);

/// s, by gravity and the velocities of bodies. What motions ask for is not known before their
/// tables are read: choose_step_of_motions() (lib/run/motion_step.h). 0: nothing moves the fluid.
double auto_step(const Scene& scene);

}  // namespace pbf::inline scene_module
