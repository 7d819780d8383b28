// What a solid obstacle adds at a place: the share of the kernel that lies in it.
#pragma once

#include "kernels/boundary/obstacle.h"
#include "kernels/boundary/solid_share.h"

namespace pbf::inline PBF_VARIANT {

/// share: the part of the integral of the unit kernel that is in the solid, 0 to 1, without the
/// amplitude of walls. gradient: per h.
template <class Real>
struct SolidTerm {
  Real share = 0;
  Vec3<Real> gradient;
};

/// 0 to 1 across the place where a capsule's tube meets its end, over 0.44 ranges on either side:
/// C2, step(-z) = 1 - step(z). The exact step depends on the distance too; this one is within 0.03.
template <class Real>
PBF_HD HalfSpace<Real> capsule_step(Real z) {
  constexpr Real per(1 / 0.88);
  const Real s = z * per + Real(0.5);
  if (!(s > Real(0))) return {};
  if (!(s < Real(1))) return {Real(1), Real(0)};
  const Real s2 = s * s, t = Real(1) - s;
  return {s2 * s * (Real(10) - s * (Real(15) - Real(6) * s)), Real(30) * per * s2 * (t * t)};
}

/// A box: the product of its slabs, exact before faces and for plates of any thickness. Outside at
/// edges and corners within 0.0014, of plates 0.0019; in the plane 0.003, Poly6's 0.005.
template <Smoothing S, bool of_density, class Real>
PBF_HD SolidTerm<Real> box_term(const Solid<Real>& o, Vec3<Real> p, Real inv_range) {
  const Real one(1), at[3] = {p.x, p.y, p.z};
  Real above[3], below[3], outside = 0;
  HalfSpace<Real> slab[3] = {{one, Real(0)}, {one, Real(0)}, {one, Real(0)}};
  constexpr int step = dimensions_of(S) == 2 ? 2 : 1;
  for (int axis = 0; axis < 3; axis += step) {
    const Span<Real> s = span_of(o, axis);
    above[axis] = (at[axis] - s.high) * inv_range, below[axis] = (s.low - at[axis]) * inv_range;
    const Real q = max2(max2(above[axis], below[axis]), Real(0));
    outside = outside + q * q;
  }
  if (outside >= one) return {};
  for (int axis = 0; axis < 3; axis += step)
    slab[axis] = slab_share<S, of_density>(above[axis], below[axis]);
  const Real x = slab[0].density, y = slab[1].density, z = slab[2].density;
  return {x * y * z, {slab[0].slope * (y * z), slab[1].slope * (x * z), slab[2].slope * (x * y)}};
}

/// Sphere, cylinder and capsule: by the distance from a centre or an axis.
template <Smoothing S, bool of_density, class Real>
PBF_HD SolidTerm<Real> round_term(const Solid<Real>& o, Vec3<Real> p, Real inv_range) {
  constexpr bool flat = dimensions_of(S) == 2;
  const Real one(1), radius = o.half.x * inv_range;
  const bool cylinder = o.shape == ObstacleShape::cylinder;
  const bool capsule = o.shape == ObstacleShape::capsule;
  const Span<Real> axis = span_of(o, 2);
  const Real above = (p.z - axis.high) * inv_range, below = (axis.low - p.z) * inv_range;
  Vec3<Real> d = capsule ? off_axis(o, p) : p;
  if (cylinder) d.z = 0;
  d = inv_range * d;
  const Real square = dot(d, d), reach = radius + one;
  if (square >= reach * reach) return {};
  const Real c = square_root(square), inv_c = one / max2(c, Real(1e-20));

  if (!flat && o.shape == ObstacleShape::sphere) {
    const HalfSpace<Real> g = ball_share<S, of_density>(c, radius);
    return {g.density, (g.slope * inv_c) * d};
  }
  HalfSpace<Real> bend{cylinder && !flat ? Real(0) : one, Real(0)};
  if (capsule) {
    const HalfSpace<Real> up = capsule_step(above), down = capsule_step(below);
    bend = {up.density + down.density, up.slope - down.slope};
  }
  HalfSpace<Real> slab{one, Real(0)};
  if (cylinder && !flat) {
    const Real side = max2(c - radius, Real(0)), end = max2(max2(above, below), Real(0));
    if (side * side + end * end >= one) return {};
    slab = slab_share<S, of_density>(above, below);
  }
  const RoundShare<Real> g = round_share<S, of_density>(c - radius, radius, bend.density);
  SolidTerm<Real> w{g.share * slab.density, (g.slope * slab.density * inv_c) * d};
  w.gradient.z = w.gradient.z + g.by_bend * bend.slope + g.share * slab.slope;
  return w;
}

/// In body coordinates, the gradient per range.
template <Smoothing S, bool of_density, class Real>
PBF_HD SolidTerm<Real> body_term(const Solid<Real>& o, Vec3<Real> p, Real inv_range) {
  if (o.shape == ObstacleShape::box) return box_term<S, of_density>(o, p, inv_range);
  if (o.shape != ObstacleShape::plane) return round_term<S, of_density>(o, p, inv_range);
  const HalfSpace<Real> g = half_space_share<S, of_density>(p.z * inv_range);
  return {g.density, {Real(0), Real(0), g.slope}};
}

/// What the obstacle adds at x; inv_range: h over the range of the walls. 0 beyond the range, 1
/// deep inside. The gradient is the derivative of the share with the consistent kernels; with the
/// paper's the share is Poly6's and the gradient Spiky's, as of walls.
template <Smoothing S, class Real>
PBF_HD_APART SolidTerm<Real> solid_term(const Solid<Real>& o, Vec3<Real> x, Real inv_range) {
  constexpr int D = dimensions_of(S);
  const Vec3<Real> p = body_point<D>(o, x);
  SolidTerm<Real> w = body_term<S, false>(o, p, inv_range);
  if constexpr (is_paper(S)) w.share = body_term<S, true>(o, p, inv_range).share;
  w.gradient = inv_range * turned_back<D>(o, w.gradient);
  return w;
}

}  // namespace pbf::inline PBF_VARIANT
