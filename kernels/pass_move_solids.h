// The start of a step where solids move, or the tank: what of the table is this step's.
#pragma once

#include "kernels/boundary/surroundings.h"

namespace pbf::inline PBF_VARIANT {

/// What becomes of a moving solid in a step.
template <class Real>
struct SolidStep {
  int solid = 0;          ///< which one
  PlacedSolid<Real> now;  ///< at the end of the step; its bounds hold the whole way
  Solid<Real> before;     ///< at the start
  SolidVelocity mean;     ///< of the update that the step is part of
};

/// Row *row of the table, and on to the next one: a recorded step need not know which it is.
template <class Real>
struct MoveSolidsPass {
  int* row;                                 ///< in/out
  const FrameStep<Real>* frames = nullptr;  ///< of each step; null: the tank stands
  const SolidStep<Real>* steps = nullptr;   ///< of each step `moving`
  int moving = 0;                           ///< solids
  FrameStep<Real>* frame = nullptr;         ///< out: of this step
  PlacedSolid<Real>* placed = nullptr;      ///< out: of all solids
  Solid<Real>* before = nullptr;            ///< the same
  SolidVelocity* velocity = nullptr;        ///< the same

  PBF_HD void operator()(int) const {
    const int now = *row;
    *row = now + 1;
    if (frames) *frame = frames[now];
    for (int k = 0; k < moving; ++k) {
      const SolidStep<Real>& s = steps[now * moving + k];
      placed[s.solid] = s.now;
      before[s.solid] = s.before;
      velocity[s.solid] = s.mean;
    }
  }
};

}  // namespace pbf::inline PBF_VARIANT
