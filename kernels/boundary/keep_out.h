// Where a path ends that meets a solid obstacle.
#pragma once

#include "kernels/boundary/obstacle.h"

namespace pbf::inline PBF_VARIANT {

template <class Real>
struct PathEnd {
  Vec3<Real> x;
  bool hit = false;
};

/// A tangent plane of the solid, which lies where normal . p <= level; body coordinates.
template <class Real>
struct Tangent {
  Vec3<Real> normal;
  Real level = 0;
};

/// The part of a line a + t d between two times; none where enter >= leave.
template <class Real>
struct Stay {
  Real enter = 1, leave = 0;
};
template <class Real>
PBF_HD Stay<Real> both(Stay<Real> a, Stay<Real> b) {
  return {max2(a.enter, b.enter), min2(a.leave, b.leave)};
}

/// The stay of a coordinate inside a span.
template <class Real>
PBF_HD Stay<Real> stay_between(Real a, Real d, Span<Real> s) {
  constexpr Real ever(1e30);
  if (d == Real(0)) return a > s.low && a < s.high ? Stay<Real>{-ever, ever} : Stay<Real>{};
  const Real t = (s.low - a) / d, u = (s.high - a) / d;
  return t < u ? Stay<Real>{t, u} : Stay<Real>{u, t};
}

/// The stay within a distance of the origin.
template <class Real>
PBF_HD Stay<Real> stay_near(Vec3<Real> a, Vec3<Real> d, Real radius) {
  constexpr Real ever(1e30);
  const Real dd = dot(d, d);
  if (!(dd > Real(1e-30)))
    return dot(a, a) < radius * radius ? Stay<Real>{-ever, ever} : Stay<Real>{};
  const Real middle = -dot(a, d) / dd;
  const Vec3<Real> p = a + middle * d;  // not b^2 - ac: that cancels on long paths
  const Real rest = radius * radius - dot(p, p);
  if (!(rest > Real(0))) return {};
  const Real half = square_root(rest / dd);
  return {middle - half, middle + half};
}

/// The tangent plane at the direction d from a centre or an axis.
template <int D, class Real>
PBF_HD Tangent<Real> round_tangent(const Solid<Real>& o, Vec3<Real> d, Real level) {
  const Real length = square_root(dot(d, d));
  if (length > Real(1e-15)) return {(Real(1) / length) * d, level};
  // On the axis any normal across it will do; in two dimensions one of the plane.
  const Real off = o.turn[0][1] < Real(0) ? -o.turn[0][1] : o.turn[0][1];
  if (D == 2 && off > Real(0.5)) return {{Real(0), Real(1), Real(0)}, level};
  return {{Real(1), Real(0), Real(0)}, level};
}

template <int D, class Real>
PBF_HD Tangent<Real> capsule_tangent(const Solid<Real>& o, Vec3<Real> p) {
  Tangent<Real> t = round_tangent<D>(o, off_axis(o, p), o.half.x);
  t.level = t.level + t.normal.z * on_axis(o, p.z);
  return t;
}

/// The face of an axis of the body, on the upper or the lower side.
template <class Real>
PBF_HD Tangent<Real> face_of(const Solid<Real>& o, int axis, bool upper) {
  const Span<Real> s = span_of(o, axis);
  const Real n(upper ? 1 : -1);
  return {{axis == 0 ? n : Real(0), axis == 1 ? n : Real(0), axis == 2 ? n : Real(0)},
          upper ? s.high : -s.low};
}

/// The tangent plane at the place of the surface that is nearest to p, which is inside.
template <int D, class Real>
PBF_HD Tangent<Real> nearest_tangent(const Solid<Real>& o, Vec3<Real> p) {
  const Real at[3] = {p.x, p.y, p.z}, radius = o.half.x;
  if (o.shape == ObstacleShape::plane) return {{Real(0), Real(0), Real(1)}, Real(0)};
  if (o.shape == ObstacleShape::sphere) return round_tangent<D>(o, p, radius);
  if (o.shape == ObstacleShape::capsule) return capsule_tangent<D>(o, p);
  Tangent<Real> best;
  Real depth(4e9);
  if (o.shape == ObstacleShape::cylinder) {
    best = round_tangent<D>(o, Vec3<Real>{p.x, p.y, Real(0)}, radius);
    depth = radius - square_root(p.x * p.x + p.y * p.y);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!has_faces<D>(o, axis)) continue;
    const Span<Real> s = span_of(o, axis);
    const bool upper = s.high - at[axis] < at[axis] - s.low;
    const Real d = upper ? s.high - at[axis] : at[axis] - s.low;
    if (d < depth) depth = d, best = face_of(o, axis, upper);
  }
  return best;
}

/// The stay of the line a + t d in the solid, and the tangent plane where it enters.
template <int D, class Real>
PBF_HD Stay<Real> stay_in(const Solid<Real>& o, Vec3<Real> a, Vec3<Real> d, Tangent<Real>& entry) {
  const Real radius = o.half.x, at[3] = {a.x, a.y, a.z}, way[3] = {d.x, d.y, d.z};
  if (o.shape == ObstacleShape::sphere) {
    const Stay<Real> stay = stay_near(a, d, radius);
    entry = round_tangent<D>(o, a + stay.enter * d, radius);
    return stay;
  }
  Stay<Real> stay{Real(-1e30), Real(1e30)};
  if (o.shape != ObstacleShape::box) {  // the cylinder without ends
    stay = stay_near(Vec3<Real>{a.x, a.y, Real(0)}, {d.x, d.y, Real(0)}, radius);
    if (!(stay.enter < stay.leave)) return {};
  }
  if (o.shape == ObstacleShape::capsule) {  // what is beyond its axis is in the ball at the end
    const auto at_end = [&](Real t) {
      const Real z = a.z + t * d.z, end = on_axis(o, z);
      return end == z ? Stay<Real>{t, t} : stay_near(Vec3<Real>{a.x, a.y, a.z - end}, d, radius);
    };
    const Stay<Real> first = at_end(stay.enter), last = at_end(stay.leave);
    if (first.enter > first.leave || last.enter > last.leave) return {};
    stay = {first.enter, last.leave};
    entry = capsule_tangent<D>(o, a + stay.enter * d);
    return stay;
  }
  if (o.shape == ObstacleShape::cylinder)
    entry = round_tangent<D>(o, Vec3<Real>{a.x + stay.enter * d.x, a.y + stay.enter * d.y, Real(0)},
                             radius);
  for (int axis = 0; axis < 3; ++axis) {
    if (!has_faces<D>(o, axis)) continue;
    const Stay<Real> slab = stay_between(at[axis], way[axis], span_of(o, axis));
    if (slab.enter > stay.enter) entry = face_of(o, axis, way[axis] < Real(0));
    stay = both(stay, slab);
  }
  return stay;
}

/// Where the way from `from` to `to` (h) ends: at `to` where it meets no solid, bit for bit.
/// Otherwise what is left of it behind the first place of the surface that it meets goes on along
/// the plane that touches the solid there. Obstacles are convex, so it ends outside, and on the
/// side where it met the solid, however thin that is and however long the way. A path that starts
/// inside, as by rounding or because the solid came there, starts at the nearest place of the
/// surface instead. `before`: where the solid was when the way began; seen from the solid the way
/// is straight, so that a solid sweeps all that is in its way.
template <int D, class Real>
PBF_HD_APART PathEnd<Real> keep_out(const Solid<Real>& before, const Solid<Real>& o,
                                    Vec3<Real> from, Vec3<Real> to) {
  const Vec3<Real> a = body_point<D>(before, from), b = body_point<D>(o, to);
  const Vec3<Real> d = b - a;
  Tangent<Real> face;
  if (o.shape == ObstacleShape::plane || body_distance<D>(o, a) < Real(0)) {
    face = nearest_tangent<D>(o, a);
  } else {
    Stay<Real> stay;
    if (dot(d, d) > Real(1e-30)) stay = stay_in<D>(o, a, d, face);
    const bool meets = stay.enter < stay.leave && stay.leave > Real(0);
    if (!(meets && stay.enter < Real(1))) {
      if (!(body_distance<D>(o, b) < Real(0))) return {to, false};
      if (!meets) face = nearest_tangent<D>(o, b);  // both ends are at the surface, to rounding
    }
  }
  const Real depth = face.level - dot(face.normal, b);
  if (!(depth > Real(0))) return {to, false};
  return {to + depth * turned_back<D>(o, face.normal), true};
}
/// Of a solid that stands.
template <int D, class Real>
PBF_HD PathEnd<Real> keep_out(const Solid<Real>& o, Vec3<Real> from, Vec3<Real> to) {
  return keep_out<D>(o, o, from, to);
}

}  // namespace pbf::inline PBF_VARIANT
