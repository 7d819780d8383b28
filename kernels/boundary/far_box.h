// How passes over all particles deal with solids: they leave what is near to a second launch, and
// see plain walls.
#pragma once

#include "kernels/boundary/solids.h"
#include "kernels/cell_index.h"

namespace pbf::inline PBF_VARIANT {

/// The boundary of the first launch. What is far from all solids has to do with plain walls alone;
/// of a near row a pass keeps the sums over its neighbours and goes on.
template <class Real>
struct FarBox : Box<Real> {
  static constexpr bool far_only = true;
  Bounds<Real> bounds{}, clear{};  ///< as those of Solids
  bool obstacles = false, loaded = false;
  const FrameStep<Real>* frame = nullptr;
  NearRows<Real> near{};

  explicit FarBox(const Solids<Real>& s)
      : Box<Real>(s),
        bounds(s.bounds),
        clear(s.clear),
        obstacles(s.obstacles),
        loaded(s.loaded),
        frame(s.frame),
        near(s.near) {}

  /// Whether row i, in the order of the last sort, starts the step with a speed at which it sees
  /// nothing but plain walls; else it is near from now on.
  PBF_HD bool stays_far(int i, Real speed_squared) const {
    if (!near.way_left_squared || near.may_go(i, speed_squared)) return true;
    if (!near.near(i)) near.mark_near(i);
    return false;
  }

  /// Whether a way may lead to a solid, or end near one.
  PBF_HD_RARE bool comes_near(Vec3<Real> from, Vec3<Real> to) const {
    return may_meet_solids(*this, from, to);
  }
  /// Whether row i, which is far, may be near after a move in an iteration.
  PBF_HD bool leaves(int i, Vec3<Real> from, Vec3<Real> move) const {
    return !(dot(move, move) <= near.way_left_squared[i]) && comes_near(from, from + move);
  }
  /// At least the largest gradient of the walls' density, 1/h: of a half space it is below 1.6 over
  /// the range, and three pairs of walls may be near.
  PBF_HD Real steepest() const { return Real(6) * this->scale * this->inv_range; }
};

/// Which rows are near, once the lists are made; of all rows, or of those in the half cells that
/// something can be near in. Before, all are far.
template <class Real>
struct FindNearPass {
  Solids<Real> solids;
  const Vec4<Real>* position;
  const int* half_cell = nullptr;  ///< null: the pass is for rows
  const int* bin_start = nullptr;
  int bins = 0;  ///< of a half cell
  PBF_HD void operator()(int k) const {
    if (!half_cell) return solids.came_to(k, xyz(position[k]));
    const int* start = bin_start + half_cell[k] * bins;
    for (int i = start[0]; i < start[bins]; ++i) solids.came_to(i, xyz(position[i]));
  }
};

/// Makes the rows of the list far again.
template <class Real>
struct ForgetNearPass {
  NearRows<Real> near;
  PBF_HD void operator()(int k) const { near.way_left_squared[near.row[k]] = near.far_way_squared; }
};
template <class Real>
struct ClearNearPass {
  NearRows<Real> near;
  PBF_HD void operator()(int) const { *near.count = 0; }
};
/// Where nothing is known of the n rows all of them are near.
template <class Real>
struct AllNearPass {
  NearRows<Real> near;
  int n;
  PBF_HD void operator()(int i) const {
    near.way_left_squared[i] = Real(-1);
    near.row[i] = i;
    if (i == 0) *near.count = n;
  }
};

}  // namespace pbf::inline PBF_VARIANT
