// A solid: a shape and its pose.
#pragma once

#include "kernels/shapes/shapes.h"

namespace pbf::PBF_VARIANT {

/// The pose of a body. Lengths in h, in the internal frame.
template <class Real>
struct BodyFrame {
  Vec3<Real> center;
  Real turn[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< body coordinates: turn * (x - center)
};

/// Plain data, stored in device memory. In two dimensions (D = 2) y is ignored: bodies are cut by
/// the plane of the scene.
template <class Real>
struct Solid : BodyFrame<Real> {
  SomeShape<Real> shape;
};

template <int D, class Real>
PBF_HD Vec3<Real> body_point(const BodyFrame<Real>& o, Vec3<Real> x) {
  Vec3<Real> d = x - o.center;
  if constexpr (D == 2) d.y = 0;
  return {o.turn[0][0] * d.x + o.turn[0][1] * d.y + o.turn[0][2] * d.z,
          o.turn[1][0] * d.x + o.turn[1][1] * d.y + o.turn[1][2] * d.z,
          o.turn[2][0] * d.x + o.turn[2][1] * d.y + o.turn[2][2] * d.z};
}
/// A direction in body coordinates, in the frame of the domain.
template <int D, class Real>
PBF_HD Vec3<Real> turned_back(const BodyFrame<Real>& o, Vec3<Real> d) {
  const Vec3<Real> back{o.turn[0][0] * d.x + o.turn[1][0] * d.y + o.turn[2][0] * d.z,
                        o.turn[0][1] * d.x + o.turn[1][1] * d.y + o.turn[2][1] * d.z,
                        o.turn[0][2] * d.x + o.turn[1][2] * d.y + o.turn[2][2] * d.z};
  if constexpr (D == 2) return {back.x, Real(0), back.z};
  return back;
}

/// A normal across the body's z where none is unique; in two dimensions it lies in the plane.
template <int D, class Real>
PBF_HD Vec3<Real> any_across(const BodyFrame<Real>& o) {
  const Real off = o.turn[0][1] < Real(0) ? -o.turn[0][1] : o.turn[0][1];
  if (D == 2 && off > Real(0.5)) return {Real(0), Real(1), Real(0)};
  return {Real(1), Real(0), Real(0)};
}

/// Distance of x from the surface, h; negative inside. Exact inside and outside.
template <int D = 3, class Real>
PBF_HD_APART Real distance(const Solid<Real>& o, Vec3<Real> x) {
  const Vec3<Real> p = body_point<D>(o, x);
  return o.shape.with([&](const auto& s) { return s.template distance<D>(p); });
}
/// Outward unit normal at the point of the surface nearest to x.
template <int D = 3, class Real>
PBF_HD_APART Vec3<Real> normal(const Solid<Real>& o, Vec3<Real> x) {
  const Vec3<Real> p = body_point<D>(o, x);
  const Vec3<Real> n = o.shape.with([&](const auto& s) { return s.template normal<D>(p); });
  return turned_back<D>(o, dot(n, n) > Real(0) ? n : any_across<D>(o));
}

/// Whether the solid continues behind a wall at its end in direction d from the center.
template <class Shape, class Real>
PBF_HD bool goes_on(const Shape& shape, Vec3<Real> d) {
  if constexpr (requires { shape.through; }) {
    const Real along[3] = {d.x, d.y, d.z};
    for (int axis = 0; axis < 3; ++axis)
      if (along[axis] != Real(0) && (shape.through >> (2 * axis) & (along[axis] < 0 ? 1u : 2u)))
        return true;
  }
  return false;
}
/// h: extent of the body from its center along d, a unit vector in the frame of the domain.
/// `through`: includes parts that continue behind walls.
template <class Real>
PBF_HD_APART Real reach_along(const Solid<Real>& o, Vec3<Real> d, bool through) {
  const Vec3<Real> in_body{o.turn[0][0] * d.x + o.turn[0][1] * d.y + o.turn[0][2] * d.z,
                           o.turn[1][0] * d.x + o.turn[1][1] * d.y + o.turn[1][2] * d.z,
                           o.turn[2][0] * d.x + o.turn[2][1] * d.y + o.turn[2][2] * d.z};
  return o.shape.with([&](const auto& s) {
    return through && goes_on(s, in_body) ? Real(kEndless) : reach_of(s, in_body);
  });
}
/// h: largest extent of the body from its center, without parts that continue behind walls.
template <class Real>
PBF_HD_APART Real size_of(const Solid<Real>& o) {
  return o.shape.with([](const auto& s) { return size_of_shape<Real>(s); });
}
/// However large it is.
template <class Real>
PBF_HD bool is_bounded(const Solid<Real>& o) {
  return o.shape.with([](const auto& s) {
    return !requires { s.endless; };
  });
}

}  // namespace pbf::PBF_VARIANT
