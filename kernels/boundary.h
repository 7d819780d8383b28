// Planar walls: what the half space behind a wall, filled with fluid at rest, adds to the density,
// in closed form, and the clamp that is the last resort. q = distance/h from the wall.
#pragma once

#include "kernels/params.h"
#include "kernels/smoothing.h"

namespace pbf::inline PBF_VARIANT {

/// Density of the half space, as a fraction of rho0, and its gradient along the inward normal
/// (negative: it decreases inward), both 0 for q >= 1. A particle on or behind the wall: q = 0.
template <class Real>
struct HalfSpace {
  Real density = 0, slope = 0;
};

/// Spiky: D = (1-q)^5 (1+2q)/2; its derivative:
/// D' = (1-q)^4 (-5(1+2q) + 2(1-q))/2 = -(3/2)(1-q)^4 (1+4q).
template <class Real>
PBF_HD HalfSpace<Real> half_space_spiky(Real q) {
  if (!(q < Real(1))) return {};
  q = max2(q, Real(0));
  Real t = Real(1) - q, t2 = t * t, t4 = t2 * t2;
  return {Real(0.5) * t4 * t * (Real(1) + q + q), Real(-1.5) * t4 * (Real(1) + Real(4) * q)};
}

/// Poly6: D = 1/2 - 315/256 (q - 4q^3/3 + 6q^5/5 - 4q^7/7 + q^9/9), D' = -315/256 (1-q^2)^4.
template <class Real>
PBF_HD HalfSpace<Real> half_space_poly6(Real q) {
  if (!(q < Real(1))) return {};
  q = max2(q, Real(0));
  Real s = q * q, u = Real(1) - s, u2 = u * u;
  Real p = Real(1) + s * (Real(-4.0 / 3.0) +
                          s * (Real(6.0 / 5.0) + s * (Real(-4.0 / 7.0) + s * Real(1.0 / 9.0))));
  Real a = Real(315.0 / 256.0);
  return {max2(Real(0.5) - a * q * p, Real(0)), -a * u2 * u2};
}

/// In two dimensions D = (1-q)^m P(q), P = 1/2 + c1 q + c2 q^2 + c3 q^3 + c4 q^4, fitted to the
/// integral over the half plane, which holds arc functions (how near: kernels/README.md (9)); the
/// slope is this polynomial's own derivative, (1-q)^(m-1) ((1-q) P' - m P).
template <int m, class Real>
PBF_HD HalfSpace<Real> half_plane(Real q, Real c1, Real c2, Real c3, Real c4) {
  static_assert(m == 4 || m == 5);
  if (!(q < Real(1))) return {};
  q = max2(q, Real(0));
  const Real t = Real(1) - q, t3 = t * t * t, before = m == 5 ? t3 * t : t3;
  const Real p = Real(0.5) + q * (c1 + q * (c2 + q * (c3 + q * c4)));
  const Real dp = c1 + q * (Real(2) * c2 + q * (Real(3) * c3 + q * (Real(4) * c4)));
  return {before * t * p, before * (t * dp - Real(m) * p)};
}
template <class Real>
PBF_HD HalfSpace<Real> half_plane_spiky(Real q) {
  return half_plane<5>(q, Real(0.90627), Real(-0.19345), Real(1.18431), Real(0));
}
template <class Real>
PBF_HD HalfSpace<Real> half_plane_poly6(Real q) {
  return half_plane<4>(q, Real(0.83646), Real(0.31849), Real(-0.09827), Real(-0.75489));
}

/// The half space of the density kernel, and of the gradient's, with the dimensions of S.
template <class Real, Smoothing S>
PBF_HD HalfSpace<Real> gradient_half_space(Real q) {
  if constexpr (dimensions_of(S) == 2) return half_plane_spiky(q);
  return half_space_spiky(q);
}
template <class Real, Smoothing S>
PBF_HD HalfSpace<Real> density_half_space(Real q) {
  if constexpr (!is_paper(S)) return gradient_half_space<Real, S>(q);
  if constexpr (dimensions_of(S) == 2) return half_plane_poly6(q);
  return half_space_poly6(q);
}

/// Contribution of all walls at x: density in units of rho0 and gradient in rho0/h.
template <class Real>
struct WallTerm {
  Real density = 0;
  Vec3<Real> gradient;
};

/// Each wall adds A D(q/kappa), with amplitude A = wall_scale and range kappa = 1/wall_inv_range
/// from lib/program/calibrate.h. The walls' union is taken by inclusion-exclusion,
/// 1 - prod(1 - A D_k): exact for one wall, an approximation where two half spaces overlap (its
/// error: tests/oracle). In `paper` the density's D is Poly6's, the gradient's Spiky's, as for
/// particles.
template <class Real, Smoothing S>
PBF_HD WallTerm<Real> wall_term(Vec3<Real> x, const Params<Real>& p) {
  WallTerm<Real> w;
  if (!p.wall_density) return w;
  const Real one(1);
  constexpr bool flat = dimensions_of(S) == 2;  // no wall along y
  if (x.x >= one && (flat || x.y >= one) && x.z >= one && x.x <= p.box.x - one &&
      (flat || x.y <= p.box.y - one) && x.z <= p.box.z - one)
    return w;
  const Real distance[6] = {x.x, p.box.x - x.x, x.y, p.box.y - x.y, x.z, p.box.z - x.z};
  Real keep_density = one, keep[3] = {one, one, one}, slope[3] = {0, 0, 0};
  for (int axis = 0; axis < 3; axis += flat ? 2 : 1)
    for (int side = 0; side < 2; ++side) {
      const int face = 2 * axis + side;
      const Real q = distance[face] * p.wall_inv_range;
      if (!(p.walls & (1u << face)) || !(q < one)) continue;
      const HalfSpace<Real> g = gradient_half_space<Real, S>(q);
      const Real d = is_paper(S) ? density_half_space<Real, S>(q).density : g.density;
      keep_density = keep_density * (one - p.wall_scale * d);
      // d/dx of 1 - A D(q/kappa), and the product rule where opposite walls are near each other.
      const Real f = one - p.wall_scale * g.density;
      const Real s = p.wall_scale * p.wall_inv_range * (side == 0 ? g.slope : -g.slope);
      slope[axis] = slope[axis] * f - s * keep[axis];
      keep[axis] = keep[axis] * f;
    }
  // The gradient of 1 - prod(keep): minus the product rule's sum.
  w.density = one - keep_density;
  w.gradient = {-slope[0] * keep[1] * keep[2], -slope[1] * keep[0] * keep[2],
                -slope[2] * keep[0] * keep[1]};
  return w;
}

template <class Real>
PBF_HD Real clamp_axis(Real x, Real low, Real high, bool wall_low, bool wall_high) {
  if (wall_low && x < low) x = low;
  if (wall_high && x > high) x = high;
  return x;
}

/// x moved to the nearest place inside the walls.
template <class Real>
PBF_HD Vec3<Real> clamp_inside(Vec3<Real> x, const Params<Real>& p) {
  return {clamp_axis(x.x, p.margin, p.box.x - p.margin, p.walls & x_min, p.walls & x_max),
          clamp_axis(x.y, p.margin, p.box.y - p.margin, p.walls & y_min, p.walls & y_max),
          clamp_axis(x.z, p.margin, p.box.z - p.margin, p.walls & z_min, p.walls & z_max)};
}

}  // namespace pbf::inline PBF_VARIANT
