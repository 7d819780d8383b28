// The exact solution of the constraints of one update, and the distance of a solver's result from
// it. lib/solver/DIAGNOSTICS.md defines both.
#pragma once

#include <vector>

#include "lib/program/plan.h"
#include "lib/scene/scene.h"
#include "lib/solver/solver.h"

namespace pbf::test {

/// Where the particles would go with no constraint but the clamp: x* = x + dt (v + dt g), damping
/// and clamp as in the update. `position` (m) and `velocity` (m/s) of 3n values, as is the result.
std::vector<double> predicted_positions(const Scene& scene, const Plan& plan,
                                        const std::vector<double>& position,
                                        const std::vector<double>& velocity);

struct Projection {
  std::vector<double> position;  ///< m, 3n
  bool converged = false;        ///< what follows is at rounding level
  int iterations = 0;            ///< linearisations
  double violation = 0;          ///< 1, largest C left (|C| two-sided); in spacings that of a wall
  double stationarity = 0;       ///< d, largest |x - x* + J^T mu|
  double complementarity = 0;    ///< h^2, largest |mu C|
};

/// The point nearest to the predicted positions `start` (m, 3n) that satisfies every constraint of
/// the scene: densities (pairs those of `start`, walls included) and the clamp. Without convergence
/// (an over-full box has no such point) `converged` is false and the rest is the last iterate.
Projection project_exactly(const Scene& scene, const Plan& plan, const std::vector<double>& start);

/// Distances |x_k - x_inf| of one update in units of the spacing d.
struct ProjectionError {
  double mean = 0, rms = 0, max = 0;
  bool converged = false;  ///< of the exact projection; the distances mean nothing without
  Projection exact;
};

/// The predicted positions of the next update of a solver of this scene and plan. An update has to
/// be one substep, and obstacles are not known.
std::vector<double> projection_start(Solver& solver, const Scene& scene, const Plan& plan);
/// The error of that update, after which the solver is now.
ProjectionError projection_error(Solver& solver, const Scene& scene, const Plan& plan,
                                 const std::vector<double>& start);

}  // namespace pbf::test
