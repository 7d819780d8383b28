// predict: v += dt g, x* = x + dt v, and the bin of x*. Macklin & Mueller 2013, algorithm 1,
// lines 1-4. In time steps of second order a share of the last step's push is added to v
// (kernels/README.md, "Second order in time").
#pragma once

#include <cstdint>
#include <cstring>

#include "kernels/boundary/far_boundary.h"
#include "kernels/step_counts.h"

namespace pbf::PBF_VARIANT {

template <class Real>
struct Moving {
  Vec3<Real> x, v;     ///< h, h/s
  bool fast;           ///< above Params::speed_squared, before it was limited
  Real mark = 1;       ///< -1: so fast that it may pass a neighbor (relative_motion.h), else 1
  Vec3<Real> aimed{};  ///< h/s, the velocity before walls and solids changed it
};

/// The share of the last step's push that the prediction takes over, h/s; in a step without time
/// the whole push, which stays as it is. v: velocity at the end of that step; free: what it would
/// have been without the push of the constraints, or null if time steps are of first order.
template <class Real>
PBF_HD Vec3<Real> carried_push(const Vec4<Real>* free, int i, Vec3<Real> v, const Params<Real>& p) {
  if (!free) return {};
  const Vec3<Real> push = v - xyz(free[i]);
  return p.dt > Real(0) ? p.carry * push : push;
}

/// The velocity after gravity, or the tank's motion, and damping of a step.
template <class Real, class Boundary>
PBF_HD Vec3<Real> accelerated(Vec3<Real> x, Vec3<Real> v, const Params<Real>& p,
                              const Boundary& boundary) {
  if constexpr (requires { boundary.frame; }) {
    if (boundary.frame) return boundary.frame->accelerated(x, p.damping * v);
  }
  return mul_add(p.damping, v, p.dt * p.gravity);
}

/// v: already accelerated. The position is clamped to the walls, and the velocity follows the
/// clamp, so that no particle is behind a wall after `predict`, with or without iterations.
/// push: carried_push(). path_end(from, to): that of the boundary.
template <class Real, class End>
PBF_HD Moving<Real> predicted(Vec3<Real> x, Vec3<Real> v, Vec3<Real> push, const Params<Real>& p,
                              End&& path_end) {
  if (p.carry > Real(0)) v = v + push;
  const Real speed_squared = dot(v, v);
  const bool fast = speed_squared > p.speed_squared;
  if (p.limit_speed && fast) v = square_root(p.speed_squared / speed_squared) * v;
  const Vec3<Real> free = mul_add(p.dt, v, x);
  x = path_end(x, free);
  // Only a clamped coordinate changes v: elsewhere x - free is exactly 0.
  const Real mark = speed_squared > p.passing_squared ? Real(-1) : Real(1);
  return {x, mul_add(p.inv_dt, x - free, v), fast, mark, v};
}
/// The same with plain walls only.
template <class Real, class Boundary>
PBF_HD Moving<Real> predict(Vec3<Real> x, Vec3<Real> v, Vec3<Real> push, const Params<Real>& p,
                            const Boundary& boundary) {
  const Box<Real>& walls = boundary;
  return predicted(x, accelerated(x, v, p, boundary), push, p,
                   [&](auto from, auto to) { return walls.path_end(from, to); });
}
/// The same for particle i with solids; books loads of walls and solids.
template <class Real, class Boundary>
PBF_HD_APART Moving<Real> predict_at_solids(int i, Vec3<Real> x, Vec3<Real> v, Vec3<Real> push,
                                            const Params<Real>& p, const Boundary& boundary) {
  return predicted(x, accelerated(x, v, p, boundary), push, p, [&](auto from, auto to) {
    return boundary.path_end(boundary.booked, true, i, from, to);
  });
}
/// The same for particle i, wherever it has moved since the last sort; books loads.
template <class Real, class Boundary>
PBF_HD Moving<Real> predict_anywhere(int i, Vec3<Real> x, Vec3<Real> v, Vec3<Real> push,
                                     const Params<Real>& p, const Boundary& boundary) {
  if constexpr (Boundary::books)
    return predict_at_solids(i, x, v, push, p, boundary);
  else
    return predict(x, v, push, p, boundary);
}

/// Writes x* of particle i, the matching velocity and, unless `free` is null, the velocity without
/// any push of the constraints in this step.
template <class Real>
PBF_HD void put(int i, const Moving<Real>& m, Vec3<Real> push, OwnRows<Vec4<Real>> position,
                OwnRows<Vec4<Real>> velocity, Vec4<Real>* free, StepCounts* counts) {
  if (m.fast) count_one(&counts->fast);
  position[i] = with_w(m.x, m.mark);
  velocity[i] = with_w(m.v, Real(0));
  if (free) free[i] = with_w(m.aimed - push, Real(0));
}
/// The same for particle i at x with velocity v.
template <class Real, class Boundary>
PBF_HD void move_on(int i, Vec3<Real> x, Vec3<Real> v, const Params<Real>& p,
                    const Boundary& boundary, OwnRows<Vec4<Real>> position,
                    OwnRows<Vec4<Real>> velocity, Vec4<Real>* free, StepCounts* counts) {
  const Vec3<Real> push = carried_push(free, i, v, p);
  const Moving<Real> m = predict_anywhere(i, x, v, push, p, boundary);
  if constexpr (Boundary::books) boundary.came_to(i, m.x);
  put(i, m, push, position, velocity, free, counts);
}

/// The bin of x* of row i, or -1 if NearPredictPass computes it.
template <int D, class Real, class Boundary>
PBF_HD int predicted_bin(int i, Vec3<Real> x, Vec3<Real> v, const Vec4<Real>* free,
                         const Params<Real>& p, const Boundary& boundary) {
  const Vec3<Real> push = carried_push(free, i, v, p);
  if constexpr (Boundary::far_only) {
    Vec3<Real> faster = accelerated(x, v, p, boundary);
    if (p.carry > Real(0)) faster = faster + push;
    if (!boundary.stays_far(i, dot(faster, faster))) return -1;
  }
  return bin_of<D>(predict(x, v, push, p, boundary).x, p);
}

/// The bin of x*. x* itself is computed once more where the particles are gathered, which is
/// cheaper than writing and reading it.
template <class Real, class Boundary, int D>
struct PredictPass {
  static constexpr bool leaves_rows = Boundary::far_only;  ///< to NearPredictPass
  Params<Real> p;
  Boundary boundary;
  OwnRows<const Vec4<Real>> position, velocity;
  const Vec4<Real>* free;  ///< null in first order
  int* bin;                ///< out
  PBF_HD void operator()(int i) const {
    bin[i] = predicted_bin<D>(i, xyz(position[i]), xyz(velocity[i]), free, p, boundary);
  }
};

/// Predicts the near rows in place: x* with the mark, the matching velocity, and the bin.
template <class Real, int D>
struct NearPredictPass {
  Params<Real> p;
  SolidBoundary<Real> boundary;
  OwnRows<Vec4<Real>> position, velocity;  ///< in/out
  Vec4<Real>* free;                        ///< in/out; null in first order
  int* bin;                                ///< out
  StepCounts* counts;
  PBF_HD int row(int k) const { return boundary.near.row[k]; }
  PBF_HD void operator()(int k) const {
    const int i = row(k);
    const Vec3<Real> v = xyz(velocity[i]), push = carried_push(free, i, v, p);
    const Moving<Real> m = predict_at_solids(i, xyz(position[i]), v, push, p, boundary);
    put(i, m, push, position, velocity, free, counts);
    bin[i] = bin_of<D>(m.x, p);
  }
};

/// x* and the matching velocity, in place: for further substeps, and for examining this step alone.
template <class Real, class Boundary>
struct MovePass {
  Params<Real> p;
  Boundary boundary;
  OwnRows<Vec4<Real>> position, velocity;  ///< in/out
  Vec4<Real>* free;                        ///< in/out; null in first order
  StepCounts* counts;
  PBF_HD void operator()(int i) const {
    const Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    if constexpr (Boundary::books) {
      // Most paths meet at most plain walls; solids are evaluated for the others alone.
      const Vec3<Real> push = carried_push(free, i, v, p);
      const Moving<Real> m = predict(x, v, push, p, boundary);
      if (!may_meet_solids(boundary, x, m.x))
        return put(i, m, push, position, velocity, free, counts);
    }
    move_on(i, x, v, p, boundary, position, velocity, free, counts);
  }
};

/// The bin of the present position, for the state before the first update.
template <class Real, int D>
struct BinPass {
  Params<Real> p;
  OwnRows<const Vec4<Real>> position;
  int* bin;  ///< out
  PBF_HD void operator()(int i) const { bin[i] = bin_of<D>(xyz(position[i]), p); }
};

/// Further arrays of particles that a sort copies, in words of 4 bytes.
struct CarriedRows {
  static constexpr int most = 8;
  struct Part {
    const std::uint32_t* from = nullptr;
    std::uint32_t* to = nullptr;
    int words = 0;  ///< of a row
  };
  Part part[most];
  int parts = 0;
  PBF_HD void carry(int from, int to) const {
    for (int k = 0; k < parts; ++k)
      for (int w = 0; w < part[k].words; ++w)
        std::memcpy(part[k].to + std::int64_t(to) * part[k].words + w,
                    part[k].from + std::int64_t(from) * part[k].words + w, 4);
  }
};
struct NothingCarried {
  PBF_HD void carry(int, int) const {}
};

/// Copies the particles into the order of bins. With `moving` they are predicted; w of the position
/// is then 1 (1/density, until an iteration replaces it), or -1 as a mark for the first iteration.
/// Otherwise w is copied.
template <class Real, class Boundary, bool moving, class Carried>
struct GatherPass : Carried {
  Params<Real> p;
  Boundary boundary;
  const Vec4<Real>*position, *velocity, *free;  ///< free: null in first order
  const int* id;
  Vec4<Real>*position_out, *velocity_out, *free_out;
  int* id_out;
  StepCounts* counts;
  PBF_HD void operator()(int from, int to) const {
    const Vec4<Real> at = position[from];
    Moving<Real> m{xyz(at), xyz(velocity[from]), false};
    const bool stays = !moving || is_predicted(from);
    Vec3<Real> push{};
    if (stays) {
      m.mark = at.w;
    } else {
      push = carried_push(free, from, m.v, p);
      m = predict(m.x, m.v, push, p, boundary);
    }
    if (m.fast) count_one(&counts->fast);
    position_out[to] = with_w(m.x, m.mark);
    velocity_out[to] = with_w(m.v, Real(0));
    if (free) free_out[to] = stays ? free[from] : with_w(m.aimed - push, Real(0));
    id_out[to] = id[from];
    this->carry(from, to);
  }
  PBF_HD bool is_predicted(int from) const {
    if constexpr (Boundary::far_only)
      return boundary.near.way_left_squared && boundary.near.near(from);
    return false;
  }
};

}  // namespace pbf::PBF_VARIANT
