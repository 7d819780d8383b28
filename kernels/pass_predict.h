// predict: v += dt g, x* = x + dt v, and the bin of x*. Macklin & Mueller 2013, algorithm 1,
// lines 1-4. In time steps of second order a share of the last step's push is added to v
// (kernels/README.md, "Second order in time").
#pragma once

#include <cstdint>
#include <cstring>

#include "kernels/boundary/far_boundary.h"
#include "kernels/packed_position.h"
#include "kernels/step_counts.h"
#include "kernels/time_order.h"

namespace pbf::PBF_VARIANT {

/// V: Real, or several of them (kernels/lanes.h), as in predicted_bin().
template <class V>
struct Moving {
  Vec3<V> x, v;              ///< h, h/s
  decltype(V() < V()) fast;  ///< above Params::speed_squared, before it was limited
  V mark = 1;  ///< -1: so fast that it may pass a neighbor (relative_motion.h), else 1
};

/// No push is taken over from the last step.
struct NoPush {};
/// The share of the last step's push that the prediction of particle i takes over, h/s; in a step
/// without time the whole push, which stays as it is. v: velocity at the end of the last step.
template <class V, class Real, class Index, class Order>
PBF_HD auto carried_push(const Order& order, Index i, Vec3<V> v, const Params<Real>& p) {
  if constexpr (Order::second) {
    const Vec3<V> push = v - xyz(row(OwnRows(order.free), i));
    return p.dt > Real(0) ? p.carry * push : push;
  } else {
    return NoPush{};
  }
}
template <class V, class Real>
PBF_HD Vec3<V> pushed(Vec3<V> v, NoPush, const Params<Real>&) {
  return v;
}
template <class V, class Real>
PBF_HD Vec3<V> pushed(Vec3<V> v, Vec3<V> push, const Params<Real>& p) {
  return p.dt > Real(0) ? v + push : v;
}

/// The velocity after gravity, or the tank's motion, and damping of a step.
template <class V, class Real, class Boundary>
PBF_HD Vec3<V> accelerated(Vec3<V> x, Vec3<V> v, const Params<Real>& p, const Boundary& boundary) {
  if constexpr (requires { boundary.frame; }) {
    if (boundary.frame) return boundary.frame->accelerated(x, p.damping * v);
  }
  return mul_add(p.damping, v, p.dt * p.gravity);
}

/// v: already accelerated. The position is clamped to the walls, and the velocity follows the
/// clamp, so that no particle is behind a wall after `predict`, with or without iterations.
/// push: carried_push(). path_end(from, to): that of the boundary.
template <class V, class Real, class Push, class End>
PBF_HD Moving<V> predicted(Vec3<V> x, Vec3<V> v, const Push& push, const Params<Real>& p,
                           End&& path_end) {
  v = pushed(v, push, p);
  const V speed_squared = dot(v, v);
  const auto fast = speed_squared > p.speed_squared;
  if (p.limit_speed && holds_somewhere(fast))
    v = choose(fast, square_root(p.speed_squared / speed_squared) * v, v);
  const Vec3<V> free = mul_add(p.dt, v, x);
  const auto [end, still] = path_end(x, free);
  // Only a clamped coordinate changes v: elsewhere end - free is exactly 0.
  const V mark = choose(speed_squared > p.passing_squared, V(-1), V(1));
  return {end, mul_add(p.inv_dt, end - free - still, v), fast, mark};
}
/// The same with plain walls only.
template <class V, class Real, class Push, class Boundary>
PBF_HD Moving<V> predict(Vec3<V> x, Vec3<V> v, const Push& push, const Params<Real>& p,
                         const Boundary& boundary) {
  const Box<Real>& walls = boundary;
  return predicted(x, accelerated(x, v, p, boundary), push, p,
                   [&](auto from, auto to) { return Stop<V>{walls.path_end(from, to)}; });
}
/// The same for particle i with solids; books loads of walls and solids.
template <class Real, class Push, class Boundary>
PBF_HD_APART Moving<Real> predict_at_solids(int i, Vec3<Real> x, Vec3<Real> v, const Push& push,
                                            const Params<Real>& p, const Boundary& boundary) {
  return predicted(x, accelerated(x, v, p, boundary), push, p, [&](auto from, auto to) {
    return boundary.path_end(boundary.booked, true, i, from, to);
  });
}
/// The same for particle i, wherever it has moved since the last sort; books loads.
template <class Real, class Push, class Boundary>
PBF_HD Moving<Real> predict_anywhere(int i, Vec3<Real> x, Vec3<Real> v, const Push& push,
                                     const Params<Real>& p, const Boundary& boundary) {
  if constexpr (Boundary::books)
    return predict_at_solids(i, x, v, push, p, boundary);
  else
    return predict(x, v, push, p, boundary);
}

/// Writes the velocity of particle i without any push of the constraints in this step. What a wall
/// or solid stopped in the prediction stays stopped: it is no push, or the next step would take a
/// share of it over, and a particle would rebound.
template <class Real>
PBF_HD void put_free(FirstOrder, int, const Moving<Real>&, NoPush) {}
template <class Real>
PBF_HD void put_free(const SecondOrder<Real>& order, int i, const Moving<Real>& m,
                     Vec3<Real> push) {
  order.free[i] = with_w(m.v - push, Real(0));
}
/// Writes x* of particle i, which had velocity v, and the matching velocities.
template <class Real, class Push, class Order>
PBF_HD void put(int i, Vec3<Real> v, const Moving<Real>& m, const Push& push,
                MovedRows<Real> position, OwnRows<Vec4<Real>> velocity, const Order& order,
                StepCounts* counts) {
  if (m.fast) count_one(&counts->fast);
  order.damping.add(i, double(dot(v, v)));
  set_row(position, i, with_w(m.x, m.mark));
  velocity[i] = with_w(m.v, Real(0));
  put_free(order, i, m, push);
}
/// The same for particle i at x with velocity v.
template <class Real, class Order, class Boundary>
PBF_HD void move_on(int i, Vec3<Real> x, Vec3<Real> v, const Params<Real>& p,
                    const Boundary& boundary, MovedRows<Real> position,
                    OwnRows<Vec4<Real>> velocity, const Order& order, StepCounts* counts) {
  const auto push = carried_push(order, i, v, p);
  const Moving<Real> m = predict_anywhere(i, x, v, push, p, boundary);
  if constexpr (Boundary::books) boundary.came_to(i, m.x);
  put(i, v, m, push, position, velocity, order, counts);
}

/// The bin of x* of row i, or -1 if NearPredictPass computes it.
template <int D, class V, class Real, class Index, class Order, class Boundary>
PBF_HD auto predicted_bin(Index i, Vec3<V> x, Vec3<V> v, const Order& order, const Params<Real>& p,
                          const Boundary& boundary) {
  const auto push = carried_push(order, i, v, p);
  if constexpr (Boundary::far_only) {
    const Vec3<Real> faster = pushed(accelerated(x, v, p, boundary), push, p);
    if (!boundary.stays_far(i, dot(faster, faster))) return -1;
  }
  return bin_of<D>(predict(x, v, push, p, boundary).x, p);
}

/// The bin of x*. x* itself is computed once more where the particles are gathered, which is
/// cheaper than writing and reading it.
template <class Real, class Boundary, int D, class Order>
struct PredictPass {
  static constexpr bool leaves_rows = Boundary::far_only;  ///< to NearPredictPass
  Params<Real> p;
  Boundary boundary;
  OwnRows<const Vec4<Real>> position, velocity;
  int* bin;  ///< out
  Order order{};
  PBF_HD void operator()(int i) const {
    bin[i] = predicted_bin<D>(i, xyz(position[i]), xyz(velocity[i]), order, p, boundary);
  }
};

/// Predicts the near rows in place: x* with the mark, the matching velocity, and the bin.
template <class Real, int D, class Order>
struct NearPredictPass {
  Params<Real> p;
  SolidBoundary<Real> boundary;
  OwnRows<Vec4<Real>> position, velocity;  ///< in/out
  int* bin;                                ///< out
  StepCounts* counts;
  Order order{};  ///< in/out
  PBF_HD int row(int k) const { return boundary.near.row[k]; }
  PBF_HD void operator()(int k) const {
    const int i = row(k);
    const Vec3<Real> v = xyz(velocity[i]);
    const auto push = carried_push(order, i, v, p);
    const Moving<Real> m = predict_at_solids(i, xyz(position[i]), v, push, p, boundary);
    put(i, v, m, push, position, velocity, order, counts);
    bin[i] = bin_of<D>(m.x, p);
  }
};

/// x* and the matching velocity, in place: for further substeps, and for examining this step alone.
template <class Real, class Boundary, class Order>
struct MovePass {
  Params<Real> p;
  Boundary boundary;
  MovedRows<Real> position;      ///< in/out
  OwnRows<Vec4<Real>> velocity;  ///< in/out
  StepCounts* counts;
  Order order{};  ///< in/out
  PBF_HD void operator()(int i) const {
    const Vec3<Real> x = xyz(position[i]), v = xyz(velocity[i]);
    if constexpr (Boundary::books) {
      // Most paths meet at most plain walls; solids are evaluated for the others alone.
      const auto push = carried_push(order, i, v, p);
      const Moving<Real> m = predict(x, v, push, p, boundary);
      if (!may_meet_solids(boundary, x, m.x))
        return put(i, v, m, push, position, velocity, order, counts);
    }
    move_on(i, x, v, p, boundary, position, velocity, order, counts);
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
template <class Real, class Boundary, bool moving, class Carried, class Order>
struct GatherPass : Carried {
  Params<Real> p;
  Boundary boundary;
  const Vec4<Real>*position, *velocity;
  const int* id;
  MovedRows<Real> position_out;
  Vec4<Real>* velocity_out;
  int* id_out;
  StepCounts* counts;
  Order order{}, order_out{};
  PBF_HD void operator()(int from, int to) const {
    const Vec4<Real> at = position[from];
    Moving<Real> m{xyz(at), xyz(velocity[from]), false};
    if (!moving || is_predicted(from)) {
      m.mark = at.w;
      if constexpr (Order::second) order_out.free[to] = order.free[from];
    } else {
      const Vec3<Real> v = m.v;
      const auto push = carried_push(order, from, v, p);
      m = predict(m.x, v, push, p, boundary);
      put_free(order_out, to, m, push);
      order.damping.add(from, double(dot(v, v)));
    }
    if (m.fast) count_one(&counts->fast);
    set_row(position_out, to, with_w(m.x, m.mark));
    velocity_out[to] = with_w(m.v, Real(0));
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
