// predict: v += dt g, x* = x + dt v, and the bin of x*. Macklin & Mueller 2013, algorithm 1, l.
// 1-4.
#pragma once

#include "kernels/boundary.h"
#include "kernels/cell_index.h"

namespace pbf::inline PBF_VARIANT {

/// Position is clamped to the walls, and the velocity follows what the clamp did: a particle never
/// enters the constraint solve from behind a wall, also when there are no iterations.
template <class Real>
struct PredictPass {
  Params<Real> p;
  Vec4<Real>* position;  ///< in x, out x*; w = 1 (1/density, until a sweep replaces it)
  Vec4<Real>* velocity;  ///< in/out, h/s
  int* bin;              ///< out

  PBF_HD void operator()(int i) const {
    Vec3<Real> v = p.damping * xyz(velocity[i]) + p.dt * p.gravity;
    const Vec3<Real> free = xyz(position[i]) + p.dt * v;
    const Vec3<Real> x = clamp_inside(free, p);
    // Only a clamped coordinate changes v: elsewhere x - free is exactly 0.
    v = v + p.inv_dt * (x - free);
    position[i] = with_w(x, Real(1));
    velocity[i] = with_w(v, Real(0));
    bin[i] = bin_of(x, p);
  }
};

/// The bin of x as it is: for the state before the first update.
template <class Real>
struct BinPass {
  Params<Real> p;
  const Vec4<Real>* position;
  int* bin;
  PBF_HD void operator()(int i) const { bin[i] = bin_of(xyz(position[i]), p); }
};

/// Puts the particles in the order of bins.
template <class Real>
struct GatherPass {
  const Vec4<Real>*position, *velocity;
  const int* id;
  Vec4<Real>*position_out, *velocity_out;
  int* id_out;
  PBF_HD void operator()(int from, int to) const {
    position_out[to] = position[from];
    velocity_out[to] = velocity[from];
    id_out[to] = id[from];
  }
};

}  // namespace pbf::inline PBF_VARIANT
