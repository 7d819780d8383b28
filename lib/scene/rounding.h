// Estimates the effect of rounding on the motion in a scene from its precision, box and time step.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::inline scene_module {

/// How far the arithmetic of a scene's precision follows a fall, or without gravity the bodies'
/// velocities, along the axis where it follows worst. Positions count from the domain's lower
/// corner, so their spacing is that of numbers as large as the box.
struct Rounding {
  double spacing = 0;   ///< h, of the numbers that positions are at the far corner of the box
  double distance = 0;  ///< h, moved until the end of the run or once through the box
  double lost = 0;      ///< h, bound of what rounding takes from that: x + v dt is x again
  double slow = 0;      ///< 1, share of the velocity lost as v + g dt is rounded
};

/// Pure. From rest under gravity g for a time T, with steps of dt (time.step/solver.substeps) and
/// numbers u apart: v dt below u/2 does not move a particle, beyond that rounding is up as often as
/// down, which leaves u^2/(8 g dt^2) lost of g T^2/2; and T/dt additions to v lose a share of
/// epsilon T/(4 dt) (kernels/README.md, "Precision"). With a constant velocity each step is off by
/// up to u/2. Not seen: velocities in particle files; shorter steps of time.adaptive, which
/// come where particles move by a good part of h in one.
Rounding rounding_of(const Scene& scene);

/// h, of the numbers that positions are at the far corner of the box: Rounding::spacing.
double position_spacing(const Scene& scene);

// What is too much (kernels/README.md, "Precision").
constexpr double kLargestSpacing = 1.0 / 128;  ///< h: 0.13 % of density
constexpr double kLargestLoss = 0.01;          ///< of the distance, and of the velocity
constexpr double kLeastLoss = 0.001;           ///< h: nobody sees less
/// Spacings of numbers: fluid passes through plates of 0.1 and less, turned or not.
constexpr double kThinnestSolid = 8;

}  // namespace pbf::inline scene_module
