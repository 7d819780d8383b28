// Computes the time step for `time.step: auto`.
#pragma once

#include <string>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// The longest steps allowed by the rules, s, before the step is fitted to the frames.
struct StepRule {
  double gravity;  ///< kSafeStep sqrt(h/g); infinite without gravity
  double speed;    ///< moves the fastest body by kSafeWay h; infinite if all rest
  double longest() const { return gravity < speed ? gravity : speed; }
};

/// dt sqrt(g/h): the mean compression of a pool of 12 layers stays below 0.1 % with 4 iterations
/// (configs/README.md).
inline constexpr double kSafeStep = 0.03;
/// dt sqrt(|g|/h), the dimensionless time step; 0 without gravity. Fluid at rest falls by its
/// square, in h, per update, which determines the compression of a pool, whatever its size.
double relative_step(const Scene& scene);
/// Largest move of a body in a step, h. Fluid that moves past other fluid by 0.4 h may pass through
/// it (kernels/relative_motion.h), and falling fluid accelerates.
inline constexpr double kSafeWay = 0.2;

StepRule step_rule(const Scene& scene);

/// The longest step, s, up to `longest` that divides output.every; without output, `longest` cut to
/// two digits. Independent of time.end, which --resume may change. 0 if `longest` is infinite.
double fitted_step(const Scene& scene, double longest);

/// The step from gravity and the velocities of bodies, s; 0 if nothing moves the fluid. For
/// motions, whose tables are read later, see choose_step_of_motions() (lib/run/motion_files.h).
double auto_step(const Scene& scene);

}  // namespace pbf::scene_module
