// The rows near solids: passes over all particles leave them to a second launch over these few.
#pragma once

#include "kernels/atomics.h"
#include "kernels/vec3.h"

namespace pbf::inline PBF_VARIANT {

/// h: so much farther than it is felt a solid counts as near when the rows are found.
constexpr double kNearRoom = 0.5;

/// The rows near solids, or near walls with loads, since the lists were made.
template <class Real>
struct NearRows {
  /// h^2, of each row: the square of what it may move in an iteration before somebody must look
  /// whether it came near; below 0 if it is near. So one comparison tells both.
  Real* way_left_squared = nullptr;
  int* row = nullptr;          ///< those that are near, in no order
  int* count = nullptr;        ///< of these
  Vec4<Real>* sums = nullptr;  ///< of each row; free between the passes of an iteration
  Real far_way_squared = 0;    ///< way_left_squared of rows that are not near
  /// That over the square of the speed at which a far row may meet something in a step.
  Real per_speed = 0;

  PBF_HD bool near(int i) const { return way_left_squared[i] < Real(0); }
  PBF_HD void mark_near(int i) const {
    way_left_squared[i] = Real(-1);
    row[take_place(count)] = i;
  }
  /// Whether row i, with that speed, goes on from where it came in the last iteration as if there
  /// were no solids.
  PBF_HD bool may_go(int i, Real speed_squared) const {
    return speed_squared * per_speed <= way_left_squared[i];
  }
};

/// A pass over as many items as *count says, which knows the row of each.
template <class Pass>
struct Listed {
  const int* count;  ///< null: none
  Pass pass;
};
struct NothingListed {};

}  // namespace pbf::inline PBF_VARIANT
