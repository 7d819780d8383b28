// Time steps of second order: which scenes have them, and the constants of the scheme.
#pragma once

#include "lib/scene/scene.h"

namespace pbf::program_module {

/// The default is the second order, and for the paper's formulation the first.
inline bool is_second_order(const Scene& s) {
  return s.time.order == TimeOrder::automatic ? s.solver.kernels != KernelMode::paper
                                              : s.time.order == TimeOrder::second;
}

inline bool is_first_order(const Scene& s) { return !is_second_order(s); }

/// Directions of corrections are those of x* - kDirectionsBack dt v, and the prediction takes over
/// kCarriedPush of the last step's push. The force of a step then acts on average where the step
/// begins, as in Verlet's scheme, if kCarriedPush = (1 - kDirectionsBack)/(2 - kDirectionsBack).
/// Why these: kernels/README.md, "Second order in time".
inline constexpr double kDirectionsBack = 1.0 / 3, kCarriedPush = 0.4;

/// Name of the field with the length of the last step.
inline constexpr const char* kStepLengthField = "step length";

}  // namespace pbf::program_module
