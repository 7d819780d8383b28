// A solid obstacle: a convex body in its own frame, and how far a place is from its surface.
#pragma once

#include "kernels/boundary/box.h"
#include "kernels/boundary/obstacle_shape.h"

namespace pbf::inline PBF_VARIANT {

/// Lengths in h, in the internal frame. Plain data: it is passed in device memory.
/// In two dimensions (D = 2) y counts nowhere: a box has no faces along the y of its body, which is
/// that of the domain; spheres, and cylinders along y, are discs; a capsule's axis lies in the
/// plane.
template <class Real>
struct Solid {
  ObstacleShape shape = ObstacleShape::plane;
  Vec3<Real> center;
  Real turn[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< body coordinates: turn * (x - center)
  /// box: half edges. cylinder, capsule: z = half the length of the axis (body z), x = radius.
  /// sphere: x = radius. plane: not used, the solid is where body z < 0.
  Vec3<Real> half;
  /// Faces in the body frame (bits as WallBit) behind which the solid goes on, as where it stands
  /// against a wall of the domain: such a face is none. Box, cylinder and capsule (its ends: z).
  unsigned through = 0;
};

/// Where the solid ends along an axis of the body; beyond everything where it goes on.
template <class Real>
struct Span {
  Real low, high;
};
template <class Real>
PBF_HD Span<Real> span_of(const Solid<Real>& o, int axis) {
  constexpr Real far(1e9);  // h; its square is a float too
  const Real half = axis == 0 ? o.half.x : axis == 1 ? o.half.y : o.half.z;
  return {o.through & (1u << (2 * axis)) ? -far : -half,
          o.through & (2u << (2 * axis)) ? far : half};
}

template <int D, class Real>
PBF_HD Vec3<Real> body_point(const Solid<Real>& o, Vec3<Real> x) {
  Vec3<Real> d = x - o.center;
  if constexpr (D == 2) d.y = 0;
  return {o.turn[0][0] * d.x + o.turn[0][1] * d.y + o.turn[0][2] * d.z,
          o.turn[1][0] * d.x + o.turn[1][1] * d.y + o.turn[1][2] * d.z,
          o.turn[2][0] * d.x + o.turn[2][1] * d.y + o.turn[2][2] * d.z};
}
/// A direction of the body in the frame of the domain.
template <int D, class Real>
PBF_HD Vec3<Real> turned_back(const Solid<Real>& o, Vec3<Real> d) {
  const Vec3<Real> back{o.turn[0][0] * d.x + o.turn[1][0] * d.y + o.turn[2][0] * d.z,
                        o.turn[0][1] * d.x + o.turn[1][1] * d.y + o.turn[2][1] * d.z,
                        o.turn[0][2] * d.x + o.turn[1][2] * d.y + o.turn[2][2] * d.z};
  if constexpr (D == 2) return {back.x, Real(0), back.z};
  return back;
}

/// The height on a capsule's axis that is nearest to body z.
template <class Real>
PBF_HD Real on_axis(const Solid<Real>& o, Real z) {
  const Span<Real> axis = span_of(o, 2);
  return max2(min2(z, axis.high), axis.low);
}
template <class Real>
PBF_HD Vec3<Real> off_axis(const Solid<Real>& o, Vec3<Real> p) {
  return {p.x, p.y, p.z - on_axis(o, p.z)};
}

/// The axes along which a shape has faces.
template <int D, class Real>
PBF_HD bool has_faces(const Solid<Real>& o, int axis) {
  if (o.shape == ObstacleShape::box) return D == 3 || axis != 1;
  return o.shape == ObstacleShape::cylinder && D == 3 && axis == 2;
}

/// Distance from the surface of a place in body coordinates, h; below 0 inside.
template <int D, class Real>
PBF_HD Real body_distance(const Solid<Real>& o, Vec3<Real> p) {
  if (o.shape == ObstacleShape::plane) return p.z;
  if (o.shape == ObstacleShape::sphere) return square_root(dot(p, p)) - o.half.x;
  if (o.shape == ObstacleShape::capsule) {
    const Vec3<Real> d = off_axis(o, p);
    return square_root(dot(d, d)) - o.half.x;
  }
  // Faces at right angles: inside the nearest one counts, outside all that the place is beyond.
  const Real at[3] = {p.x, p.y, p.z};
  Real nearest(-4e9), outside = 0;
  const auto face = [&](Real s) {
    nearest = max2(nearest, s);
    if (s > Real(0)) outside = outside + s * s;
  };
  if (o.shape == ObstacleShape::cylinder) face(square_root(p.x * p.x + p.y * p.y) - o.half.x);
  for (int axis = 0; axis < 3; ++axis) {
    const Span<Real> s = span_of(o, axis);
    if (has_faces<D>(o, axis)) face(max2(at[axis] - s.high, s.low - at[axis]));
  }
  return nearest > Real(0) ? square_root(outside) : nearest;
}

/// Distance of x from the surface, h; below 0 inside. Exact on both sides.
template <int D = 3, class Real>
PBF_HD_APART Real distance(const Solid<Real>& o, Vec3<Real> x) {
  return body_distance<D>(o, body_point<D>(o, x));
}

}  // namespace pbf::inline PBF_VARIANT
