// The end of a path that meets a solid obstacle.
#pragma once

#include "kernels/boundary/obstacle.h"

namespace pbf::PBF_VARIANT {

template <class Real>
struct PathEnd {
  Vec3<Real> x;
  bool hit = false;
  bool again = false;  ///< x is still inside: evaluate the same solid once more
};

/// The displacement out of a shape, in body coordinates.
template <class Real>
struct WayOut {
  Vec3<Real> normal;
  Real depth = 0;  ///< h, along the normal; 0: none is needed
  bool again = false;
};
/// For a path from a to b. `frame`: the pose of the body.
template <int D, class Shape, class Real>
PBF_HD WayOut<Real> way_out(const Shape& s, const BodyFrame<Real>& frame, Vec3<Real> a,
                            Vec3<Real> b) {
  Tangent<Real> face;
  bool met = false;
  const Real away = s.template distance<D>(a);
  const bool within = away < Real(0);
  if (within) face = tangent_of<D>(s, a);
  // What leaves a body that is not convex may meet it again.
  const auto is_behind = [&] { return face.level - dot(face.normal, b) > kTouchingFace<Real>; };
  const Vec3<Real> from = within && !Shape::convex ? a - away * face.normal : a;
  if (!within || (!Shape::convex && !is_behind())) {
    const Vec3<Real> d = b - from;
    LineSpan<Real> inside;
    if (dot(d, d) > Real(1e-30)) inside = line_span_of<D>(s, from, d, face);
    const bool meets = inside.enter < inside.leave && inside.leave > Real(0);
    met = meets && inside.enter < Real(1);
    if (!met) {
      if (!(s.template distance<D>(b) < Real(0))) return {};
      if (!meets) face = tangent_of<D>(s, b);  // both ends are at the surface, to rounding
    }
  }
  if (!(dot(face.normal, face.normal) > Real(0))) face.normal = any_across<D>(frame);
  WayOut<Real> out{face.normal, max2(face.level - dot(face.normal, b), Real(0))};
  if constexpr (!Shape::convex) {
    const Vec3<Real> end = b + out.depth * out.normal;
    out.again =
        (met && !(out.depth > Real(0))) || s.template distance<D>(end) < -kTouchingFace<Real>;
    // The way along the face may meet another one.
    if (!out.again && out.depth > Real(0)) {
      Tangent<Real> other;
      const LineSpan<Real> rest = line_span_of<D>(s, from, end - from, other);
      out.again = rest.enter < rest.leave && rest.enter < Real(1);
    }
  }
  return out;
}

/// The end of a path from `from` to `to` (h): `to`, bit for bit, if it meets no solid. Otherwise
/// the rest of the path behind the first point of contact continues along the tangent plane there.
/// If the shape is convex, the path ends outside, on the side where it met the solid, for any
/// thickness of the solid and any length of the path. A path that starts inside, because of
/// rounding or because the solid moved there, starts at the nearest point of the surface instead.
/// `before`: the solid at the start of the path. The path is straight in the frame of the solid, so
/// a moving solid sweeps away what is in its path.
template <int D, class Real>
PBF_HD_APART PathEnd<Real> keep_out(const Solid<Real>& before, const Solid<Real>& o,
                                    Vec3<Real> from, Vec3<Real> to) {
  const Vec3<Real> a = body_point<D>(before, from), b = body_point<D>(o, to);
  const WayOut<Real> out = o.shape.with([&](const auto& s) { return way_out<D>(s, o, a, b); });
  if (!(out.depth > Real(0))) return {to, out.again, out.again};
  return {to + out.depth * turned_back<D>(o, out.normal), true, out.again};
}
/// The same for a solid at rest.
template <int D, class Real>
PBF_HD PathEnd<Real> keep_out(const Solid<Real>& o, Vec3<Real> from, Vec3<Real> to) {
  return keep_out<D>(o, o, from, to);
}

}  // namespace pbf::PBF_VARIANT
