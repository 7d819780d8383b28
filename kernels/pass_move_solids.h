// The start of a step in which solids or the tank move: takes this step's row of the table.
#pragma once

#include "kernels/boundary/solid_scene.h"

namespace pbf::PBF_VARIANT {

/// The motion of a solid in a step.
template <class Real>
struct PoseStep {
  int solid = 0;         ///< which one
  PosedSolid<Real> now;  ///< at the end of the step; its bounds cover the whole path
  Solid<Real> before;    ///< at the start
  SolidVelocity mean;    ///< of the update that the step is part of
};

/// Copies row *row of the table and advances *row, so a recorded step needs no row number.
template <class Real>
struct MoveSolidsPass {
  int* row;                                 ///< in/out
  const FrameStep<Real>* frames = nullptr;  ///< of each step; null: the tank is at rest
  const PoseStep<Real>* steps = nullptr;    ///< `moving` rows for each step
  int moving = 0;                           ///< number of moving solids
  FrameStep<Real>* frame = nullptr;         ///< out: of this step
  PosedSolid<Real>* placed = nullptr;       ///< out: of all solids
  Solid<Real>* before = nullptr;            ///< the same
  SolidVelocity* velocity = nullptr;        ///< the same

  PBF_HD void operator()(int) const {
    const int now = *row;
    *row = now + 1;
    if (frames) *frame = frames[now];
    for (int k = 0; k < moving; ++k) {
      const PoseStep<Real>& s = steps[now * moving + k];
      placed[s.solid] = s.now;
      before[s.solid] = s.before;
      velocity[s.solid] = s.mean;
    }
  }
};

}  // namespace pbf::PBF_VARIANT
