// Removes the compression of the initial state before the first update.
#pragma once

#include <functional>
#include <string>

#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace pbf::run_module {

/// What prestabilize() did.
struct Prestabilized {
  int steps = 0;              ///< without time; 0: the start is unchanged
  Diagnostics before, after;  ///< of the start; the second if there were steps
  double moved = 0;           ///< spacings, upper bound for every particle
  double kick = 0;            ///< J, energy of the moves of one more step, over dt
  double harmless = 0;        ///< J, the kick at which the steps end
  bool relieved() const { return kick <= harmless; }
};

/// A compressed start gives its particles the velocity dx/dt in the first updates, so a shorter
/// step adds more energy. This function removes the compression in steps without time (Macklin et
/// al. 2014, Unified particle physics for real-time applications, ACM TOG 33(4), "initial
/// conditions"), until the kick of one more step, sum m |dx|^2/2 / dt^2, is below 1e-5 of
/// energy_scale() or below the effect of rounding; or until doubling the steps reduces it by less
/// than a quarter (an over-full box); in at most 2048 iterations. dt is a substep at the finest
/// level of time.adaptive. Velocities do not change. Does nothing if solver.prestabilize is false
/// or there are no iterations, and after settle(), which has relieved the start. Only measures if
/// the compression is harmless. The bits do not depend on the number of threads. Call it before the
/// first measurement, never for a resumed state. `progress` gets a line after every round.
Prestabilized prestabilize(Solver& solver, const Scene& scene, const Plan& plan,
                           const std::function<void(const std::string&)>& progress = {});

/// One line for the log; empty if there is nothing to report.
std::string prestabilized_text(const Prestabilized& p);

}  // namespace pbf::run_module
