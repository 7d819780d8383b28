// Faces perpendicular to the axes of a body; some of them may not exist.
#pragma once

#include "kernels/shapes/shape.h"

namespace pbf::PBF_VARIANT {

/// The ends of a body along an axis; +-kEndless where it continues. `through`: faces (bits as
/// WallBit) behind which the solid continues, for example behind a wall of the domain.
template <class Real>
struct Span {
  Real low, high;
};
template <class Real>
PBF_HD Span<Real> span_of(Real half, unsigned through, int axis) {
  constexpr Real far(kEndless);
  return {through & (1u << (2 * axis)) ? -far : -half, through & (2u << (2 * axis)) ? far : half};
}

/// The distance from perpendicular faces: inside, from the nearest one; outside, from all faces
/// that the point is beyond.
template <class Real>
struct FaceDistance {
  Real nearest = Real(-4e9), outside = 0;

  PBF_HD void face(Real s) {
    nearest = max2(nearest, s);
    if (s > Real(0)) outside = outside + s * s;
  }
  PBF_HD void slab(Real at, Span<Real> s) { face(max2(at - s.high, s.low - at)); }
  PBF_HD Real value() const { return nearest > Real(0) ? square_root(outside) : nearest; }
};

/// The upper or lower face of the body on an axis.
template <class Real>
PBF_HD Tangent<Real> face_of(Span<Real> s, int axis, bool upper) {
  const Real n(upper ? 1 : -1);
  return {{axis == 0 ? n : Real(0), axis == 1 ? n : Real(0), axis == 2 ? n : Real(0)},
          upper ? s.high : -s.low};
}

/// The nearest face of a point inside.
template <class Real>
struct NearestFace {
  Tangent<Real> best;
  Real depth = Real(4e9);

  PBF_HD void slab(Real at, Span<Real> s, int axis) {
    const bool upper = s.high - at < at - s.low;
    const Real d = upper ? s.high - at : at - s.low;
    if (d < depth) depth = d, best = face_of(s, axis, upper);
  }
};
/// How far a coordinate is beyond its span, with its sign.
template <class Real>
PBF_HD Real beyond(Real at, Span<Real> s) {
  return max2(at - s.high, Real(0)) - max2(s.low - at, Real(0));
}
/// The tangent plane of a convex surface at p - d, its point nearest to p.
template <class Real>
PBF_HD Tangent<Real> tangent_towards(Vec3<Real> p, Vec3<Real> d) {
  const Real away = square_root(dot(d, d));
  const Vec3<Real> n = (Real(1) / away) * d;
  return {n, dot(n, p) - away};
}

template <class Real>
PBF_HD LineSpan<Real> both(LineSpan<Real> a, LineSpan<Real> b) {
  return {max2(a.enter, b.enter), min2(a.leave, b.leave)};
}
/// The part of the line a + t d whose coordinate is inside a span.
template <class Real>
PBF_HD LineSpan<Real> line_span_between(Real a, Real d, Span<Real> s) {
  constexpr Real ever(1e30);
  if (d == Real(0)) return a > s.low && a < s.high ? LineSpan<Real>{-ever, ever} : LineSpan<Real>{};
  const Real t = (s.low - a) / d, u = (s.high - a) / d;
  return t < u ? LineSpan<Real>{t, u} : LineSpan<Real>{u, t};
}
/// Intersects `inside` with the slab of an axis; `entry`: the face where the rest enters.
template <class Real>
PBF_HD void cut_line_span(LineSpan<Real>& inside, Tangent<Real>& entry, Real at, Real way,
                          Span<Real> s, int axis) {
  const LineSpan<Real> slab = line_span_between(at, way, s);
  if (slab.enter > inside.enter) entry = face_of(s, axis, way < Real(0));
  inside = both(inside, slab);
}

}  // namespace pbf::PBF_VARIANT
