// Where a path ends that meets a solid obstacle.
#pragma once

#include "kernels/boundary/obstacle.h"

namespace pbf::inline PBF_VARIANT {

template <class Real>
struct PathEnd {
  Vec3<Real> x;
  bool hit = false;
  bool again = false;  ///< x is inside: the same solid must be asked once more
};

/// The way out of a shape, in its coordinates.
template <class Real>
struct WayOut {
  Vec3<Real> normal;
  Real depth = 0;  ///< h, 0: none is needed
  bool again = false;
};
/// Of what goes from a to b. `frame`: where the body is.
template <int D, class Shape, class Real>
PBF_HD WayOut<Real> way_out(const Shape& s, const BodyFrame<Real>& frame, Vec3<Real> a,
                            Vec3<Real> b) {
  const Vec3<Real> d = b - a;
  Tangent<Real> face;
  if (s.template distance<D>(a) < Real(0)) {
    face = tangent_of<D>(s, a);
  } else {
    Stay<Real> stay;
    if (dot(d, d) > Real(1e-30)) stay = stay_of<D>(s, a, d, face);
    const bool meets = stay.enter < stay.leave && stay.leave > Real(0);
    if (!(meets && stay.enter < Real(1))) {
      if (!(s.template distance<D>(b) < Real(0))) return {};
      if (!meets) face = tangent_of<D>(s, b);  // both ends are at the surface, to rounding
    }
  }
  if (!(dot(face.normal, face.normal) > Real(0))) face.normal = any_across<D>(frame);
  WayOut<Real> out{face.normal, max2(face.level - dot(face.normal, b), Real(0))};
  if constexpr (!Shape::convex)
    out.again = s.template distance<D>(b + out.depth * out.normal) < -kTouching<Real>;
  return out;
}

/// Where the way from `from` to `to` (h) ends: at `to` where it meets no solid, bit for bit.
/// Otherwise what is left of it behind the first place of the surface that it meets goes on along
/// the plane that touches the solid there. Of a convex shape it so ends outside, and on the side
/// where it met the solid, however thin that is and however long the way. A path that starts
/// inside, as by rounding or because the solid came there, starts at the nearest place of the
/// surface instead. `before`: where the solid was when the way began; seen from the solid the way
/// is straight, so that a solid sweeps all that is in its way.
template <int D, class Real>
PBF_HD_APART PathEnd<Real> keep_out(const Solid<Real>& before, const Solid<Real>& o,
                                    Vec3<Real> from, Vec3<Real> to) {
  const Vec3<Real> a = body_point<D>(before, from), b = body_point<D>(o, to);
  const WayOut<Real> out = o.shape.with([&](const auto& s) { return way_out<D>(s, o, a, b); });
  if (!(out.depth > Real(0))) return {to, out.again, out.again};
  return {to + out.depth * turned_back<D>(o, out.normal), true, out.again};
}
/// Of a solid that stands.
template <int D, class Real>
PBF_HD PathEnd<Real> keep_out(const Solid<Real>& o, Vec3<Real> from, Vec3<Real> to) {
  return keep_out<D>(o, o, from, to);
}

}  // namespace pbf::inline PBF_VARIANT
