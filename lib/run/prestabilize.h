// Removes the compression of the initial state before the first update.
#pragma once

#include <functional>
#include <string>

#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace pbf::inline run_module {

/// What prestabilize() did.
struct Prestabilized {
  int steps = 0;                  ///< without time; 0: the start is as it was given
  double compression_before = 0;  ///< mean, 1
  double most_before = 0;         ///< 1, of the most compressed particle
  double compression_after = 0;   ///< mean, 1
  double most_after = 0;          ///< 1
  double moved = 0;               ///< spacings, no particle went farther
  double kick = 0;                ///< J, what one more step would move them by, over dt
  double harmless = 0;            ///< J, the kick at which the steps end
  bool relieved() const { return kick <= harmless; }
};

/// A compressed start gives its particles dx/dt in the first updates, so the shorter the step, the
/// more energy. This takes the compression out in steps without time (Macklin et al. 2014, Unified
/// particle physics for real-time applications, ACM TOG 33(4), "initial conditions"), until the
/// kick of one more, sum m |dx|^2/2 / dt^2, is below 1e-5 of energy_scale() or what rounding of the
/// positions alone gives; or until twice the steps take less than a quarter off it (an over-full
/// box); in at most 2048 iterations. dt is that of a substep, at the finest level of time.adaptive.
/// Velocities stay. Nothing happens where solver.prestabilize is false, without iterations, and
/// beyond one measure where the compression is harmless. The same bits on any number of threads. To
/// be called before the first measure and never for a state that a run goes on from. `progress`
/// gets a line after every round.
Prestabilized prestabilize(Solver& solver, const Scene& scene, const Plan& plan,
                           const std::function<void(const std::string&)>& progress = {});

/// One line for people; empty when there is nothing to tell.
std::string prestabilized_text(const Prestabilized& p);

}  // namespace pbf::inline run_module
