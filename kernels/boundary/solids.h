// The walls of a domain where loads on them are asked for.
#pragma once

#include "kernels/boundary/box.h"
#include "kernels/boundary/loads.h"

namespace pbf::inline PBF_VARIANT {

/// Answers as a box does, and books what it does to the particles. Wall numbers are those of
/// WallBit's bits.
template <class Real>
struct Solids : Box<Real> {
  static constexpr bool books = true;
  LoadBook<Real> loads;

  /// Particle i, at x, was moved by factor * gradient of the density constraint of the walls.
  template <Smoothing S>
  PBF_HD void book_push(int i, Vec3<Real> x, Real factor) const {
    if (!loads.sums || factor == Real(0)) return;
    Real of_wall[6];
    if (!this->template slopes<S>(x, of_wall)) return;
    for (int wall = 0; wall < 6; ++wall)
      if (of_wall[wall] != Real(0)) loads.add(wall, i, x, wall / 2, factor * of_wall[wall]);
  }
  /// Particle i, at x, was held back by `way` where its path would have left the domain.
  PBF_HD void book_hold(int i, Vec3<Real> x, Vec3<Real> way) const {
    const Real along[3] = {way.x, way.y, way.z};
    if (!loads.sums) return;
    for (int axis = 0; axis < 3; ++axis)
      if (along[axis] != Real(0))
        loads.add(2 * axis + (along[axis] < Real(0)), i, x, axis, along[axis]);
  }
};

}  // namespace pbf::inline PBF_VARIANT
