// The rows near solids, which passes over all particles leave to a second launch.
#pragma once

#include "kernels/atomics.h"
#include "kernels/vec3.h"

namespace pbf::PBF_VARIANT {

/// h: rows are found as near within the range of a solid plus this distance.
constexpr double kNearRoom = 0.5;

/// The rows near solids, or near walls with loads, since the lists were made.
template <class Real>
struct NearRows {
  /// h^2, of each row: square of the distance that a far row may move in an iteration without a
  /// check for solids; negative for near rows. A move within it needs no other test.
  Real* way_left_squared = nullptr;
  int* row = nullptr;          ///< the near rows, in any order
  int* count = nullptr;        ///< number of near rows
  Vec4<Real>* sums = nullptr;  ///< of each row; unused between the passes of an iteration
  Real far_way_squared = 0;    ///< way_left_squared of rows that are not near
  /// far_way_squared over the square of the speed above which a far row may meet something.
  Real per_speed = 0;

  PBF_HD bool near(int i) const { return way_left_squared[i] < Real(0); }
  PBF_HD void mark_near(int i) const {
    way_left_squared[i] = Real(-1);
    row[take_place(count)] = i;
  }
  /// Whether row i, with this speed, can meet no solid in a step from its position after the last
  /// iteration.
  PBF_HD bool may_go(int i, Real speed_squared) const {
    return speed_squared * per_speed <= way_left_squared[i];
  }
};

/// A pass over items 0 .. *count - 1; pass.row(k) is the row of item k.
template <class Pass>
struct Listed {
  const int* count;  ///< null: none
  Pass pass;
};
struct NothingListed {};

}  // namespace pbf::PBF_VARIANT
