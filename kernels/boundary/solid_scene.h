// Obstacles, and loads on them and on walls. Only few particles need these functions, so they are
// not inlined into the passes.
#pragma once

#include "kernels/boundary/box.h"
#include "kernels/boundary/free_body.h"
#include "kernels/boundary/keep_out.h"
#include "kernels/boundary/loads.h"
#include "kernels/boundary/moving.h"
#include "kernels/boundary/solid_term.h"

namespace pbf::PBF_VARIANT {

/// An obstacle, and the distance up to which a particle counts as near.
template <class Real>
struct PosedSolid {
  Solid<Real> solid;
  Real reach = 0;       ///< h, from the surface
  Bounds<Real> bounds;  ///< of all points within `reach`
};

/// In the same memory as the particles. Loads 0 to 5 are those of the walls, in the order of
/// WallBit; from 6 on those of the obstacles.
template <class Real>
struct SolidScene {
  Box<Real> walls;
  const PosedSolid<Real>* solid = nullptr;
  const Solid<Real>* before = nullptr;  ///< poses at the start of the step; null: as `solid`
  /// Obstacles, then the casing of each emitter. Behind them is the bore of each casing, which is
  /// no solid where fluid is held (kernels/emission.h).
  int solids = 0;
  int casings = 0;    ///< of them
  bool flat = false;  ///< two dimensions
  LoadBook<Real> loads{};
  const BodyShare* share = nullptr;  ///< of each solid; null: none is free
  SharerSums* sharers = nullptr;     ///< kLoadParts for each solid

  PBF_HD int obstacles() const { return solids - casings; }
};

template <class Real>
PBF_HD bool is_in(const SolidScene<Real>& s, int k, Vec3<Real> x) {
  return (s.flat ? distance<2>(s.solid[k].solid, x) : distance<3>(s.solid[k].solid, x)) < Real(0);
}

/// `start`: the path begins with the step, when moving solids were at SolidScene::before.
template <class Real>
PBF_HD PathEnd<Real> keep_out(const SolidScene<Real>& s, bool start, int k, Vec3<Real> from,
                              Vec3<Real> to) {
  const PosedSolid<Real>& placed = s.solid[k];
  if (!placed.bounds.meets(from, to)) return {to};
  // What is held in a bore, or leaves it, is not kept out. Nothing else is there:
  // Pipes::kept_out().
  if (k >= s.obstacles() && is_in(s, k + s.casings, from)) return {to};
  const Solid<Real>& before = start && s.before ? s.before[k] : placed.solid;
  return s.flat ? keep_out<2>(before, placed.solid, from, to)
                : keep_out<3>(before, placed.solid, from, to);
}

/// Books that obstacle k has moved particle i, which is at x, by `way`.
template <class Real>
PBF_HD void book_on(const SolidScene<Real>& s, int k, int i, Vec3<Real> x, Vec3<Real> way,
                    bool start) {
  s.loads.add(load_row_of_solid(k), i, x, way, start);
}

/// Where solid k carries the point `from` in a step.
template <class Real>
PBF_HD Vec3<Real> carried(const SolidScene<Real>& s, int k, Vec3<Real> from) {
  const Solid<Real>& o = s.solid[k].solid;
  return s.flat ? o.center + turned_back<2>(o, body_point<2>(s.before[k], from))
                : o.center + turned_back<3>(o, body_point<3>(s.before[k], from));
}
/// push_place() for solid k, in its own frame if it moves.
template <class Real>
PBF_HD Vec3<Real> push_place(const SolidScene<Real>& s, int k, Vec3<Real> x,
                             const StepWay<Real>& step) {
  if (!s.before) return push_place(x, step);
  return push_place(x, {x - carried(s, k, x - step.way), step.back});
}

template <class Real>
PBF_HD Vec3<Real> push_place(const SolidScene<Real>&, int, Vec3<Real> x, AnyWay) {
  return x;
}

template <class Real>
PBF_HD Vec3<double> in_double(Vec3<Real> a) {
  return {double(a.x), double(a.y), double(a.z)};
}
template <class Real>
PBF_HD SharerSums& sharers_of(const SolidScene<Real>& s, int k, int i) {
  return s.sharers[k * kLoadParts + LoadBook<Real>::part_of(i)];
}
/// How a particle is kept out of a solid.
template <class Real>
struct KeptOut {
  Vec3<Real> at;         ///< where it is then
  Vec3<Real> given{};    ///< the part of the way there that becomes velocity
  bool entirely = true;  ///< or it is still behind the surface
};
/// Of particle i at x, which solid k takes to `at`. A free body gives it a part of this way as
/// velocity and takes the same impulse, so that both go on with one velocity.
template <class Real>
PBF_HD KeptOut<Real> kept_out(const SolidScene<Real>& s, int k, int i, Vec3<Real> x,
                              Vec3<Real> at) {
  const Vec3<Real> way = at - x;
  if (!s.share || !s.share[k].free) return {at, way};
  const Vec3<double> w = in_double(way);
  const double squared = dot(w, w);
  if (!(squared > 0)) return {at, way};
  add_whole(&sharers_of(s, k, i).stopped, 1);
  const BodyShare& b = s.share[k];
  const double part = squared / (squared + b.among.stopped * ease_of(b, in_double(x), w));
  const double still = kMostStill / square_root(squared);
  const Vec3<Real> given = Real(part) * way;
  if (!(part + still < 1)) return {at, given};
  return {x + Real(part + still) * way, given, false};
}

/// Whether x is within the reach of an obstacle.
template <class Real>
PBF_HD_APART bool near_obstacle(const SolidScene<Real>& s, Vec3<Real> x) {
  for (int k = 0; k < s.solids; ++k) {
    const PosedSolid<Real>& o = s.solid[k];
    if (!o.bounds.has(x)) continue;
    if ((s.flat ? distance<2>(o.solid, x) : distance<3>(o.solid, x)) < o.reach) return true;
  }
  return false;
}

/// Whether a path back to the surface is within rounding: particles that slide along a face are
/// repeatedly behind it by that much.
template <class Real>
PBF_HD bool within_rounding(Vec3<Real> way, Vec3<Real> x, Vec3<Real> center) {
  const auto size = [](Vec3<Real> v) {
    return max2(v.x, -v.x) + max2(v.y, -v.y) + max2(v.z, -v.z);
  };
  constexpr Real few(sizeof(Real) == 4 ? 1e-6 : 2e-15);  // about 8 units in the last place
  const Real most = few * (Real(1) + size(x) + size(center));
  return dot(way, way) <= most * most;
}

/// Calls f(k, solid_term) for the solids from number `first` to `last` that are near x. step: of a
/// particle that they push.
template <Smoothing S, class Real, class Step, class F>
PBF_HD void for_solids_at(const SolidScene<Real>& s, int first, int last, Vec3<Real> x,
                          const Step& step, F&& f) {
  for (int k = first; k < last; ++k)
    if (s.solid[k].bounds.has(x))
      f(k, solid_term<S>(s.solid[k].solid, push_place(s, k, x, step), s.walls.inv_range));
}
/// What solids add at x; a bore takes away from its casing.
template <Smoothing S, class Real, class Step>
PBF_HD SolidTerm<Real> sum_of_solids(const SolidScene<Real>& s, Vec3<Real> x, const Step& step) {
  SolidTerm<Real> o;
  for_solids_at<S>(s, 0, s.solids, x, step, [&](int, const SolidTerm<Real>& one) {
    o.share += one.share;
    o.gradient = o.gradient + one.gradient;
  });
  if (s.casings > 0)
    for_solids_at<S>(s, s.solids, s.solids + s.casings, x, step,
                     [&](int, const SolidTerm<Real>& one) {
                       o.share -= one.share;
                       o.gradient = o.gradient - one.gradient;
                     });
  return o;
}

/// Solids are combined with the walls by inclusion and exclusion and do not overlap each other:
/// A [1 - (1 - w/A)(1 - sum o_k)].
/// step: of a particle at x that is pushed; none for the term at x.
template <Smoothing S, class Real, class Step = AnyWay>
PBF_HD_APART BoundaryTerm<Real> solid_scene_term(const SolidScene<Real>& s, Vec3<Real> x,
                                                 const Step& step = {}) {
  BoundaryTerm<Real> w = s.walls.template term<S>(push_place(x, step));
  if (!s.walls.adds_density) return w;
  const SolidTerm<Real> o = sum_of_solids<S>(s, x, step);
  // Bit for bit as with plain walls, so it does not matter which particles count as near.
  if (o.share == Real(0)) return w;
  const Real free = max2(Real(1) - o.share, Real(0)), left = s.walls.scale - w.density;
  const Real still = o.share < Real(1) ? left : Real(0);
  w.gradient = free * w.gradient + still * o.gradient;
  w.density = s.walls.scale - left * free;
  return w;
}

/// What free bodies add to the divisor of lambda of particle i, which is at x: they move, too.
template <Smoothing S, class Real>
PBF_HD_APART Real ease_of_bodies(const SolidScene<Real>& s, int i, Vec3<Real> x) {
  if (!s.walls.adds_density) return Real(0);
  const Real left = s.walls.scale - s.walls.template term<S>(x).density;
  double ease = 0;
  for_solids_at<S>(s, 0, s.obstacles(), x, AnyWay{}, [&](int k, const SolidTerm<Real>& one) {
    if (!s.share[k].free || !(one.share > Real(0))) return;
    add_whole(&sharers_of(s, k, i).pushed, 1);
    const BodyShare& b = s.share[k];
    ease += b.among.pushed * ease_of(b, in_double(x), in_double(left * one.gradient));
  });
  return Real(ease);
}

/// The end of a path of particle i. `booked`: displacements by walls and obstacles become loads.
/// `start`: see keep_out().
template <class Real>
PBF_HD_APART Stop<Real> solid_scene_path_end(const SolidScene<Real>& s, bool booked, bool start,
                                             int i, Vec3<Real> from, Vec3<Real> to) {
  const Vec3<Real> target = to;
  const auto move_by = [&](int wall, Vec3<Real> way) {
    if (!booked || wall >= load_row_of_solid(s.obstacles())) return;
    if (wall < load_row_of_solid(0)) return s.loads.add(wall, i, target, way, start);
    book_on(s, wall - load_row_of_solid(0), i, target, way, start);
  };
  const auto inside_walls = [&](Vec3<Real> x) {
    const Vec3<Real> in = s.walls.path_end(from, x), way = in - x;
    if (way.x != Real(0)) move_by(way.x < Real(0) ? 1 : 0, {way.x, Real(0), Real(0)});
    if (way.y != Real(0)) move_by(way.y < Real(0) ? 3 : 2, {Real(0), way.y, Real(0)});
    if (way.z != Real(0)) move_by(way.z < Real(0) ? 5 : 4, {Real(0), Real(0), way.z});
    return in;
  };
  to = inside_walls(to);
  Vec3<Real> still{};
  // A path along one obstacle may meet another one or a wall. If there is no way out after some
  // rounds, the particle stays where it was, or moves with the solid.
  constexpr int rounds = 3;
  for (int round = 0; round <= rounds; ++round) {
    bool moved = false;
    for (int k = 0; k < s.solids; ++k) {
      const PathEnd<Real> end = keep_out(s, start, k, from, to);
      if (!end.hit) continue;
      const bool wedged = end.again || !within_rounding(end.x - to, to, s.solid[k].solid.center);
      const bool last = round == rounds && wedged;
      // `from` may be beyond a wall by rounding: DeltaPass::place().
      const Vec3<Real> stay = start && s.before ? carried(s, k, from) : from;
      KeptOut<Real> out{last ? s.walls.path_end(from, stay) : end.x};
      if (booked) {
        out = kept_out(s, k, i, to, out.at);
        move_by(load_row_of_solid(k), out.given);
        still = still + (out.at - to - out.given);
      }
      if (last) return {out.at, still};
      to = inside_walls(out.at);
      moved = moved || (wedged && out.entirely);
    }
    if (!moved) break;
  }
  return {to, still};
}

/// Books that particle i, at x, was moved by factor * the gradient of solid_scene_term().
template <Smoothing S, class Real, class Step>
PBF_HD_APART void book_push(const SolidScene<Real>& s, int i, Vec3<Real> x, const Step& step,
                            Real factor) {
  Real of_wall[6];
  if (!s.walls.adds_density) return;
  const Vec3<Real> place = push_place(x, step);
  const bool at_wall = s.loads.of_walls() && s.walls.template slopes<S>(place, of_wall);
  const Real share = sum_of_solids<S>(s, x, step).share;
  if (share > Real(0) && share < Real(1)) {
    const Real left = s.walls.scale - s.walls.template term<S>(place).density;
    for_solids_at<S>(s, 0, s.obstacles(), x, step, [&](int k, const SolidTerm<Real>& one) {
      book_on(s, k, i, x, (factor * left) * one.gradient, false);
    });
  }
  const Real free = factor * max2(Real(1) - share, Real(0));
  for (int wall = 0; at_wall && wall < 6; ++wall) {
    const Real way = free * of_wall[wall];
    s.loads.add(wall, i, x,
                {wall / 2 == 0 ? way : Real(0), wall / 2 == 1 ? way : Real(0),
                 wall / 2 == 2 ? way : Real(0)});
  }
}

}  // namespace pbf::PBF_VARIANT
