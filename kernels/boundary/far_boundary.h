// The boundary in passes over all particles: plain walls only. Particles near solids are left to a
// second launch.
#pragma once

#include "kernels/boundary/solid_boundary.h"
#include "kernels/cell_index.h"

namespace pbf::PBF_VARIANT {

/// The boundary of the first launch. Particles far from all solids meet plain walls only. For near
/// rows, a pass only stores the sums over their neighbors.
template <class Real>
struct FarBoundary : Box<Real> {
  static constexpr bool far_only = true;
  Bounds<Real> bounds{}, clear{};  ///< as in SolidBoundary
  bool obstacles = false, loaded = false;
  const FrameStep<Real>* frame = nullptr;
  NearRows<Real> near{};

  explicit FarBoundary(const SolidBoundary<Real>& s)
      : Box<Real>(s),
        bounds(s.bounds),
        clear(s.clear),
        obstacles(s.obstacles),
        loaded(s.loaded),
        frame(s.frame),
        near(s.near) {}

  /// Whether row i, in the order of the last sort, is too slow to meet anything but plain walls in
  /// this step. Otherwise it becomes near.
  PBF_HD bool stays_far(int i, Real speed_squared) const {
    if (!near.way_left_squared || near.may_go(i, speed_squared)) return true;
    if (!near.near(i)) near.mark_near(i);
    return false;
  }

  /// Whether a path may meet a solid or end near one.
  PBF_HD_RARE bool comes_near(Vec3<Real> from, Vec3<Real> to) const {
    return may_meet_solids(*this, from, to);
  }
  /// Whether row i, which is far, may be near after a move in an iteration.
  PBF_HD bool leaves(int i, Vec3<Real> from, Vec3<Real> move) const {
    return !(dot(move, move) <= near.way_left_squared[i]) && comes_near(from, from + move);
  }
  /// An upper bound of the gradient of the walls' density, 1/h: for one half space it is below 1.6
  /// over the range, and up to three pairs of walls are within range.
  PBF_HD Real steepest() const { return Real(6) * this->scale * this->inv_range; }
};

/// Marks the near rows after the lists are made: among all rows, or only among those in the half
/// cells where this is possible. All rows are far before.
template <class Real>
struct FindNearPass {
  SolidBoundary<Real> solids;
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

/// Marks the listed rows as far.
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
/// Marks all n rows as near, for when nothing is known about them.
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

}  // namespace pbf::PBF_VARIANT
