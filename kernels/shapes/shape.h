// What the kernels ask of a solid's shape, and what follows from its distance alone where a shape
// does not give a closed form: line_span_by_steps() and smooth_share().
// tests/support/test_shapes.h has such shapes.
#pragma once

#include <concepts>

#include "kernels/boundary/solid_share.h"

namespace pbf::PBF_VARIANT {

/// h: the length of what has no end. Its square still fits a float.
constexpr double kEndless = 1e9;

/// An axis-aligned box, h.
template <class Real>
struct Bounds {
  Vec3<Real> low, high;

  PBF_HD bool has(Vec3<Real> x) const {
    return x.z <= high.z && x.z >= low.z && x.x <= high.x && x.x >= low.x && x.y <= high.y &&
           x.y >= low.y;
  }
  /// Whether a straight path may pass through it.
  PBF_HD bool meets(Vec3<Real> from, Vec3<Real> to) const {
    return !(from.z > high.z && to.z > high.z) && !(from.z < low.z && to.z < low.z) &&
           !(from.x > high.x && to.x > high.x) && !(from.x < low.x && to.x < low.x) &&
           !(from.y > high.y && to.y > high.y) && !(from.y < low.y && to.y < low.y);
  }
};

/// share: the part of the integral of the unit kernel that is in the solid, 0 to 1, without the
/// amplitude of walls. gradient: per h, or in body coordinates per range.
template <class Real>
struct SolidTerm {
  Real share = 0;
  Vec3<Real> gradient;
};

/// A tangent plane of a shape: normal . p = level. The normal is 0 where it is not unique (on an
/// axis, at a center).
template <class Real>
struct Tangent {
  Vec3<Real> normal;
  Real level = 0;
};

/// The part of a line a + t way with enter < t < leave; empty where enter >= leave.
template <class Real>
struct LineSpan {
  Real enter = 1, leave = 0;
};

/// A solid in its own coordinates, lengths in h. Plain data. With D = 2, its section by the plane
/// of the scene, in which p lies. In addition to these, a shape has a curvature or a share:
///   curvature<D>(p)                  1/h, mean curvature of the surface at the point nearest to p
///   share<S, of_density>(p, 1/range) the kernel's share in it, as SolidTerm per range
/// and where they are known in closed form:
///   tangent<D>(p)          the tangent plane at the place of the surface that is nearest to p
///   line_span<D>(a, way, entry) the part of a line that is inside, and the tangent plane where it
///                          enters
///   reach(d)               how far it goes from its origin along a direction of length 1
///   size()                 how far it goes from its origin at most
///   round<D>(p)            the round side that is nearest to p: RoundSide
///   endless                true for a shape without end on some side, like a plane
///   ends(), `through`      half lengths along its axes, and which of these ends there are not, as
///                          bits of WallBit: the solid goes on behind a wall
template <class Shape, class Real>
concept SolidShape = requires(const Shape& s, Vec3<Real> p) {
  { s.template distance<3>(p) } -> std::same_as<Real>;      // from the surface; below 0 inside
  { s.template normal<3>(p) } -> std::same_as<Vec3<Real>>;  // its gradient
  { s.bounds() } -> std::same_as<Bounds<Real>>;
  {s.template scaled<float>(1.0)};                 // scaled, with another number type
  { Shape::convex } -> std::convertible_to<bool>;  // true: the distance is a convex function
};

template <class To, class Real>
PBF_HD Vec3<To> scaled(const Vec3<Real>& v, double by) {
  return {To(by * double(v.x)), To(by * double(v.y)), To(by * double(v.z))};
}

template <int D, class Shape, class Real>
PBF_HD Tangent<Real> tangent_of(const Shape& s, Vec3<Real> p) {
  if constexpr (requires { s.template tangent<D>(p); }) {
    return s.template tangent<D>(p);
  } else {
    const Vec3<Real> n = s.template normal<D>(p);
    return {n, dot(n, p) - s.template distance<D>(p)};
  }
}

/// h, the tolerance of a contact, in the order of the rounding of distances.
template <class Real>
constexpr Real kTouching = Real(sizeof(Real) == 4 ? 2e-6 : 1e-13);
/// The same of bodies that are not convex, along whose faces paths are followed: above the rounding
/// of coordinates of 100 h.
template <class Real>
constexpr Real kTouchingFace = Real(sizeof(Real) == 4 ? 2e-5 : 1e-12);

/// Finds where a line that starts outside enters, from distances alone; `leave` is not computed.
/// Along a line, the distance from a convex body is a convex function, so Newton's steps converge
/// without passing the surface.
template <int D, class Shape, class Real>
PBF_HD LineSpan<Real> line_span_of_convex(const Shape& s, Vec3<Real> a, Vec3<Real> way,
                                          Tangent<Real>& entry) {
  constexpr Real touching = kTouching<Real>;
  Real t(0);
  for (int k = 0; k < 16 && t < Real(1); ++k) {
    const Vec3<Real> p = a + t * way;
    const Real away = s.template distance<D>(p);
    const Real down = -dot(s.template normal<D>(p), way);
    if (!(down > Real(0))) return {};
    if (away <= touching) {
      entry = tangent_of<D>(s, p);
      return {t, Real(1e30)};
    }
    t = t + max2(away, touching) / down;
  }
  return {};
}
/// The same of any body: a step is the distance, and at least an eighth of the way, so that parts
/// thinner than that may be passed. The last step is then halved some times: the tangent plane is
/// that of a place before the surface.
template <int D, class Shape, class Real>
PBF_HD LineSpan<Real> line_span_by_steps(const Shape& s, Vec3<Real> a, Vec3<Real> way,
                                         Tangent<Real>& entry) {
  if constexpr (Shape::convex) {
    return line_span_of_convex<D>(s, a, way, entry);
  } else {
    constexpr Real touching = kTouchingFace<Real>;
    const Real length = square_root(dot(way, way));
    Real before(0), t(0);
    for (int k = 0; k < 16; ++k) {
      const Vec3<Real> p = a + t * way;
      const Real away = s.template distance<D>(p);
      // What touches the surface enters it only if the line ends behind it there.
      const auto ends_behind = [&](const Tangent<Real>& at) {
        return at.level - dot(at.normal, a + way) > touching;
      };
      bool enters = away < -touching;
      if (!enters && away <= touching) enters = ends_behind(tangent_of<D>(s, p));
      if (enters) {
        for (int i = 0; i < 10 && before < t; ++i) {
          const Real middle = Real(0.5) * (before + t);
          const bool in = s.template distance<D>(a + middle * way) < -touching;
          (in ? t : before) = middle;
        }
        entry = tangent_of<D>(s, a + before * way);
        // Along one face into another one.
        if (!ends_behind(entry)) entry = tangent_of<D>(s, a + t * way);
        return {before, Real(1e30)};
      }
      if (!(t < Real(1))) return {};
      before = t;
      t = min2(Real(1), t + max2(away / length, Real(0.125)));
    }
    return {};
  }
}
template <int D, class Shape, class Real>
PBF_HD LineSpan<Real> line_span_of(const Shape& s, Vec3<Real> a, Vec3<Real> way,
                                   Tangent<Real>& entry) {
  if constexpr (requires { s.template line_span<D>(a, way, entry); })
    return s.template line_span<D>(a, way, entry);
  else
    return line_span_by_steps<D>(s, a, way, entry);
}

/// The share of a smooth body to first order in its mean curvature H (per range):
/// S - H m/(1 + H q). In two dimensions, H is that of the section. Error 0.004 if no radius of
/// curvature is below 0.5 h; for thinner bodies an estimate, never below 0.
template <Smoothing S, bool of_density, class Shape, class Real>
PBF_HD SolidTerm<Real> smooth_share(const Shape& s, Vec3<Real> p, Real inv_range) {
  constexpr int D = dimensions_of(S);
  const Real q = s.template distance<D>(p) * inv_range, one(1);
  if (!(q < one)) return {};
  const HalfSpace<Real> flat = half_space_share<S, of_density>(q);
  if (!(q > -one)) return {flat.density, {}};
  const HalfSpace<Real> m = curvature_moment<S, of_density>(q);
  const Real bend = s.template curvature<D>(p) / inv_range, r = one + bend * q;
  const bool bounded = !(r > Real(0.25));
  const Real f = bend / (bounded ? Real(0.25) : r), taken = f * m.density;
  if (!(flat.density > taken)) return {};
  const Real slope = flat.slope - f * m.slope + (bounded ? Real(0) : f * taken);
  return {flat.density - taken, slope * s.template normal<D>(p)};
}
template <Smoothing S, bool of_density, class Shape, class Real>
PBF_HD SolidTerm<Real> share_of(const Shape& s, Vec3<Real> p, Real inv_range) {
  if constexpr (requires { s.template share<S, of_density>(p, inv_range); })
    return s.template share<S, of_density>(p, inv_range);
  else
    return smooth_share<S, of_density>(s, p, inv_range);
}

/// From the closed form of a shape, otherwise from its bounds, which are no smaller.
template <class Shape, class Real>
PBF_HD Real reach_of(const Shape& s, Vec3<Real> d) {
  if constexpr (requires { s.reach(d); }) {
    return s.reach(d);
  } else {
    const Bounds<Real> b = s.bounds();
    return max2(d.x * b.low.x, d.x * b.high.x) + max2(d.y * b.low.y, d.y * b.high.y) +
           max2(d.z * b.low.z, d.z * b.high.z);
  }
}
template <class Real, class Shape>
PBF_HD Real size_of_shape(const Shape& s) {
  if constexpr (requires { s.size(); }) {
    return s.size();
  } else {
    const Bounds<Real> b = s.bounds();
    const Vec3<Real> far{max2(-b.low.x, b.high.x), max2(-b.low.y, b.high.y),
                         max2(-b.low.z, b.high.z)};
    return square_root(dot(far, far));
  }
}

/// A side at distance `radius` from the body's z axis between two heights, or from its origin if
/// both are 0. radius 0: the surface there does not have one radius.
template <class Real>
struct RoundSide {
  Real radius = 0, low = 0, high = 0;
};
template <int D, class Shape, class Real>
PBF_HD RoundSide<Real> round_of(const Shape& s, Vec3<Real> p) {
  if constexpr (requires { s.template round<D>(p); })
    return s.template round<D>(p);
  else
    return {};
}

}  // namespace pbf::PBF_VARIANT
