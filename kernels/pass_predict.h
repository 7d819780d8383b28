// predict: v += dt g, x* = x + dt v, and the bin of x*. Macklin & Mueller 2013, algorithm 1, l.
// 1-4.
#pragma once

#include "kernels/cell_index.h"
#include "kernels/step_counts.h"

namespace pbf::inline PBF_VARIANT {

template <class Real>
struct Moving {
  Vec3<Real> x, v;  ///< h, h/s
  bool fast;        ///< faster than the speed that is watched, before it was limited
  Real mark = 1;    ///< -1: so fast that it may pass a neighbour (relative_motion.h), else 1
};

/// The velocity with what gravity, or the tank's motion, and damping make of it in a step.
template <class Real, class Boundary>
PBF_HD Vec3<Real> accelerated(Vec3<Real> x, Vec3<Real> v, const Params<Real>& p,
                              const Boundary& boundary) {
  if constexpr (Boundary::books) {
    if (boundary.frame) return boundary.frame->accelerated(x, p.damping * v);
  }
  return mul_add(p.damping, v, p.dt * p.gravity);
}

/// v: accelerated. Position is clamped to the walls, and the velocity follows what the clamp did: a
/// particle never enters the constraint solve from behind a wall, also when there are no
/// iterations. path_end(from, to): of the boundary.
template <class Real, class End>
PBF_HD Moving<Real> predicted(Vec3<Real> x, Vec3<Real> v, const Params<Real>& p, End&& path_end) {
  const Real speed_squared = dot(v, v);
  const bool fast = speed_squared > p.speed_squared;
  if (p.limit_speed && fast) v = square_root(p.speed_squared / speed_squared) * v;
  const Vec3<Real> free = mul_add(p.dt, v, x);
  x = path_end(x, free);
  // Only a clamped coordinate changes v: elsewhere x - free is exactly 0.
  const Real mark = speed_squared > p.passing_squared ? Real(-1) : Real(1);
  return {x, mul_add(p.inv_dt, x - free, v), fast, mark};
}
/// With plain walls.
template <class Real, class Boundary>
PBF_HD Moving<Real> predict(Vec3<Real> x, Vec3<Real> v, const Params<Real>& p,
                            const Boundary& boundary) {
  const Box<Real>& walls = boundary;
  return predicted(x, accelerated(x, v, p, boundary), p,
                   [&](auto from, auto to) { return walls.path_end(from, to); });
}
/// Whether row i, in the order of the last sort, is predicted as if there were plain walls alone.
template <class Real, class Boundary>
PBF_HD bool sees_plain_walls(int i, Vec3<Real> x, Vec3<Real> v, const Params<Real>& p,
                             const Boundary& boundary) {
  if constexpr (Boundary::books) {
    if (!boundary.near.room) return true;
    v = accelerated(x, v, p, boundary);
    return boundary.near.may_go(i, dot(v, v));
  }
  return true;
}
/// Of particle `i`, with solids; what they do to it is booked with `book`.
template <class Real, class Boundary>
PBF_HD_APART Moving<Real> predict_at_solids(bool book, int i, Vec3<Real> x, Vec3<Real> v,
                                            const Params<Real>& p, const Boundary& boundary) {
  return predicted(x, accelerated(x, v, p, boundary), p, [&](auto from, auto to) {
    return boundary.path_end(book && boundary.booked, true, i, from, to);
  });
}
/// What row i does, which becomes row `to`.
template <class Real, class Boundary>
PBF_HD Moving<Real> predict_row(bool book, int i, int to, Vec3<Real> x, Vec3<Real> v,
                                const Params<Real>& p, const Boundary& boundary) {
  if constexpr (Boundary::books) {
    if (!sees_plain_walls(i, x, v, p, boundary))
      return predict_at_solids(book, to, x, v, p, boundary);
  }
  return predict(x, v, p, boundary);
}
/// Of particle i, wherever it has come to since the last sort; booked.
template <class Real, class Boundary>
PBF_HD Moving<Real> predict_anywhere(int i, Vec3<Real> x, Vec3<Real> v, const Params<Real>& p,
                                     const Boundary& boundary) {
  if constexpr (Boundary::books)
    return predict_at_solids(true, i, x, v, p, boundary);
  else
    return predict(x, v, p, boundary);
}

/// Writes x* and the velocity that goes with it for particle i at x with velocity v.
template <class Real, class Boundary>
PBF_HD void move_on(int i, Vec3<Real> x, Vec3<Real> v, const Params<Real>& p,
                    const Boundary& boundary, Vec4<Real>* position, Vec4<Real>* velocity,
                    StepCounts* counts) {
  const Moving<Real> m = predict_anywhere(i, x, v, p, boundary);
  if constexpr (Boundary::books) boundary.came_to(i, m.x);
  if (m.fast) count_one(&counts->fast);
  position[i] = with_w(m.x, m.mark);
  velocity[i] = with_w(m.v, Real(0));
}

/// The bin of x*. x* itself is computed once more where the particles are gathered, which is
/// cheaper than writing and reading it.
template <class Real, class Boundary, int D>
struct PredictPass {
  Params<Real> p;
  Boundary boundary;
  const Vec4<Real>*position, *velocity;
  int* bin;  ///< out
  PBF_HD void operator()(int i) const {
    if (!sees_plain_walls(i, xyz(position[i]), xyz(velocity[i]), p, boundary)) return at_solids(i);
    bin[i] = bin_of<D>(predict(xyz(position[i]), xyz(velocity[i]), p, boundary).x, p);
  }
  PBF_HD_APART void at_solids(int i) const {
    const Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    bin[i] = bin_of<D>(predict_row(false, i, i, x, v, p, boundary).x, p);
  }
};

/// x* and the velocity that goes with it, in place: for further substeps, and for
/// looking at this step alone.
template <class Real, class Boundary>
struct MovePass {
  Params<Real> p;
  Boundary boundary;
  Vec4<Real>*position, *velocity;  ///< in/out
  StepCounts* counts;
  PBF_HD void operator()(int i) const {
    move_on(i, xyz(position[i]), xyz(velocity[i]), p, boundary, position, velocity, counts);
  }
};

/// The bin of x as it is: for the state before the first update.
template <class Real, int D>
struct BinPass {
  Params<Real> p;
  const Vec4<Real>* position;
  int* bin;  ///< out
  PBF_HD void operator()(int i) const { bin[i] = bin_of<D>(xyz(position[i]), p); }
};

/// Puts the particles in the order of bins; with `moving`, as predicted. Position's w = 1
/// (1/density, until an iteration replaces it), or -1 as a mark for the first iteration.
template <class Real, class Boundary, bool moving>
struct GatherPass {
  Params<Real> p;
  Boundary boundary;
  const Vec4<Real>*position, *velocity;
  const int* id;
  Vec4<Real>*position_out, *velocity_out;
  int* id_out;
  StepCounts* counts;
  PBF_HD void operator()(int from, int to) const {
    if (moving && !sees_plain_walls(from, xyz(position[from]), xyz(velocity[from]), p, boundary))
      return at_solids(from, to);
    if constexpr (moving)
      put(from, to, predict(xyz(position[from]), xyz(velocity[from]), p, boundary));
    else
      put(from, to, {xyz(position[from]), xyz(velocity[from]), false});
  }
  PBF_HD_APART void at_solids(int from, int to) const {
    put(from, to,
        predict_row(true, from, to, xyz(position[from]), xyz(velocity[from]), p, boundary));
  }
  PBF_HD void put(int from, int to, const Moving<Real>& m) const {
    if (m.fast) count_one(&counts->fast);
    position_out[to] = with_w(m.x, m.mark);
    velocity_out[to] = with_w(m.v, Real(0));
    id_out[to] = id[from];
  }
};

}  // namespace pbf::inline PBF_VARIANT
