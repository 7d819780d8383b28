// Estimates the effect of rounding on the motion in a scene from its precision, box and time step.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// Effect of rounding on a free fall or, without gravity, on the motion of the bodies, along the
/// axis where it is largest. Positions are relative to the domain's lower corner, so their spacing
/// is that of numbers as large as the box.
struct Rounding {
  double spacing = 0;   ///< h, between positions at the far corner of the box
  double distance = 0;  ///< h, moved until the end of the run, or once through the box
  double lost = 0;      ///< h, bound of the distance lost because x + v dt rounds to x
  double slow = 0;      ///< 1, share of the velocity lost by rounding v + g dt
};

/// For a fall from rest under gravity g over a time T in steps of dt (time.step/solver.substeps),
/// with a spacing u of positions: rounding loses u^2/(8 g dt^2) of the distance g T^2/2, and a
/// share of epsilon T/(4 dt) of the velocity (kernels/README.md, "Precision"). At constant velocity
/// a step is off by up to u/2. Ignores velocities in particle files, and shorter steps of
/// time.adaptive, which occur only if particles move by a good part of h in one.
Rounding rounding_of(const Scene& scene);

/// Spacing of positions at the far corner of the box, h: Rounding::spacing.
double position_spacing(const Scene& scene);

// Limits (kernels/README.md, "Precision").
constexpr double kLargestSpacing = 1.0 / 128;  ///< h: a density error of 0.13 %
constexpr double kLargestLoss = 0.01;          ///< of the distance, and of the velocity
constexpr double kLeastLoss = 0.001;           ///< h: negligible below
/// Thinnest solid, in spacings of numbers: fluid passes through thinner ones.
constexpr double kThinnestSolid = 8;

}  // namespace pbf::scene_module
