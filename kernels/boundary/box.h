// The boundary of a domain: a box with plane walls.
#pragma once

#include "kernels/boundary/half_space.h"
#include "kernels/time_order.h"

namespace pbf::PBF_VARIANT {

enum WallBit : unsigned { x_min = 1, x_max = 2, y_min = 4, y_max = 8, z_min = 16, z_max = 32 };

/// What a boundary adds at a point: density in units of rho0 and gradient in rho0/h. Here and in
/// Box, V: Real, or several of them (kernels/lanes.h).
template <class Real>
struct BoundaryTerm {
  Real density = 0;
  Vec3<Real> gradient;
};

/// Where a path ends, and the part of the way there that is none of the velocity.
template <class Real>
struct Stop {
  Vec3<Real> x, still{};
};

/// A boundary gives passes three things: its contribution to the density and the gradient, the end
/// of a path within a step, and the distance of a particle behind it.
template <class Real>
struct Box {
  static constexpr bool books = false;     ///< whether loads are booked: solids.h
  static constexpr bool far_only = false;  ///< whether it skips near rows: far_boundary.h
  Vec3<Real> extent;                       ///< h, of the domain
  Real margin = 0;                         ///< h, distance to a wall at which particles are clamped
  unsigned walls = 63;                     ///< WallBit mask of the faces that are walls
  bool adds_density = true;                ///< the scene has `boundary: density`
  Real scale = 1;      ///< amplitude of that contribution, kernels/README.md (9)
  Real inv_range = 1;  ///< h over the range of that contribution

  /// Each wall adds A D(q/kappa), with amplitude A = `scale` and range kappa = 1/inv_range from
  /// lib/program/calibrate.h. Walls are combined by inclusion and exclusion, 1 - prod(1 - A D_k):
  /// exact for one wall, an approximation where two half spaces overlap (its error: tests/oracle).
  /// With `paper`, the density uses D of Poly6 and the gradient D of Spiky, as for particles.
  template <Smoothing S, class V>
  PBF_HD BoundaryTerm<V> term(Vec3<V> x) const;

  /// The gradient of term() where the particle at x is pushed from.
  template <Smoothing S, class V>
  PBF_HD Vec3<V> push_gradient(Vec3<V> x, const StepWay<V>& step) const {
    const auto far = far_from_walls<dimensions_of(S)>(x, Real(1 + kPushPlaceAway));
    if (holds_everywhere(far)) return {};
    return choose(far, Vec3<V>{}, term<S>(push_place(x, step)).gradient);
  }
  template <Smoothing S, class V>
  PBF_HD Vec3<V> push_gradient(Vec3<V> x, AnyWay) const {
    return term<S>(x).gradient;
  }

  /// Whether a wall may be within range.
  PBF_HD bool near_wall(Vec3<Real> x) const {
    const Real one(1);
    return x.x < one || x.y < one || x.z < one || x.x > extent.x - one || x.y > extent.y - one ||
           x.z > extent.z - one;
  }
  /// The contribution of each wall to the gradient, along its axis; false if there is none.
  template <Smoothing S>
  PBF_HD bool slopes(Vec3<Real> x, Real (&of_wall)[6]) const;

  /// The end of a path from a point inside to `to`: the point inside that is nearest to `to`.
  template <class V>
  PBF_HD Vec3<V> path_end(Vec3<V>, Vec3<V> to) const {
    return {clamped(to.x, extent.x, x_min), clamped(to.y, extent.y, y_min),
            clamped(to.z, extent.z, z_min)};
  }

  /// h, the largest distance of x behind a plane at which particles are clamped; 0 if none.
  PBF_HD double penetration(const double (&x)[3]) const {
    const double high[3] = {extent.x, extent.y, extent.z}, clamp = margin;
    double deepest = 0;
    for (int k = 0; k < 3; ++k) {
      if (walls & (1u << (2 * k))) deepest = max2(deepest, clamp - x[k]);
      if (walls & (2u << (2 * k))) deepest = max2(deepest, x[k] - (high[k] - clamp));
    }
    return deepest;
  }
  PBF_HD bool inside(Vec3<Real> x) const {
    return x.x >= Real(0) && x.y >= Real(0) && x.z >= Real(0) && x.x <= extent.x &&
           x.y <= extent.y && x.z <= extent.z;
  }
  /// Whether x is beyond a wall.
  PBF_HD bool beyond(const double (&x)[3]) const {
    const double high[3] = {extent.x, extent.y, extent.z};
    for (int k = 0; k < 3; ++k)
      if ((walls & (1u << (2 * k)) && x[k] < 0) || (walls & (2u << (2 * k)) && x[k] > high[k]))
        return true;
    return false;
  }

 private:
  /// Whether all faces are at least `range` away. 2-D: no wall along y.
  template <int D, class V>
  PBF_HD auto far_from_walls(Vec3<V> x, Real range) const {
    return x.x >= range && (D == 2 || x.y >= range) && x.z >= range && x.x <= extent.x - range &&
           (D == 2 || x.y <= extent.y - range) && x.z <= extent.z - range;
  }
  template <class V>
  PBF_HD V clamped(V x, Real high, unsigned low_wall) const {
    const Real low = margin;
    if (walls & low_wall) x = choose(x < low, V(low), x);
    if (walls & (2 * low_wall)) x = choose(x > high - margin, V(high - margin), x);
    return x;
  }
};

template <class Real>
template <Smoothing S>
PBF_HD bool Box<Real>::slopes(Vec3<Real> x, Real (&of_wall)[6]) const {
  if (!adds_density) return false;
  const Real one(1), distance[6] = {x.x, extent.x - x.x, x.y, extent.y - x.y, x.z, extent.z - x.z};
  Real kept[6], slope[6];
  bool any = false;
  for (int wall = 0; wall < 6; ++wall) {
    kept[wall] = one, slope[wall] = 0;
    const Real q = distance[wall] * inv_range;
    if (!(walls & (1u << wall)) || !(q < one)) continue;
    const HalfSpace<Real> g = gradient_half_space<Real, S>(q);
    kept[wall] = one - scale * g.density;
    slope[wall] = scale * inv_range * (wall % 2 == 0 ? g.slope : -g.slope);
    any = true;
  }
  for (int wall = 0; wall < 6; ++wall) {
    const int b = (wall + 2) % 6 / 2 * 2, c = (wall + 4) % 6 / 2 * 2;
    of_wall[wall] =
        slope[wall] * kept[wall ^ 1] * (kept[b] * kept[b + 1]) * (kept[c] * kept[c + 1]);
  }
  return any;
}

template <class Real>
template <Smoothing S, class V>
PBF_HD BoundaryTerm<V> Box<Real>::term(Vec3<V> x) const {
  BoundaryTerm<V> w;
  if (!adds_density) return w;
  const V one(1);
  constexpr bool flat = dimensions_of(S) == 2;
  const auto far = far_from_walls<dimensions_of(S)>(x, Real(1));
  if (holds_everywhere(far)) return w;
  const V distance[6] = {x.x, extent.x - x.x, x.y, extent.y - x.y, x.z, extent.z - x.z};
  V keep_density = one, keep[3] = {one, one, one}, slope[3] = {0, 0, 0};
  for (int axis = 0; axis < 3; axis += flat ? 2 : 1)
    for (int side = 0; side < 2; ++side) {
      const int face = 2 * axis + side;
      const V q = distance[face] * inv_range;
      const auto near = q < one;
      if (!(walls & (1u << face)) || !holds_somewhere(near)) continue;
      const HalfSpace<V> g = gradient_half_space<V, S>(q);
      const V d = is_paper(S) ? density_half_space<V, S>(q).density : g.density;
      keep_density = choose(near, keep_density * (one - scale * d), keep_density);
      // d/dx of 1 - A D(q/kappa), and the product rule where opposite walls are near each other.
      const V f = one - scale * g.density;
      const V s = scale * inv_range * (side == 0 ? g.slope : -g.slope);
      slope[axis] = choose(near, slope[axis] * f - s * keep[axis], slope[axis]);
      keep[axis] = choose(near, keep[axis] * f, keep[axis]);
    }
  // The gradient of 1 - prod(keep): minus the product rule's sum.
  const Vec3<V> gradient{-slope[0] * keep[1] * keep[2], -slope[1] * keep[0] * keep[2],
                         -slope[2] * keep[0] * keep[1]};
  w.density = choose(far, V(0), one - keep_density);
  w.gradient = choose(far, Vec3<V>{}, gradient);
  return w;
}

}  // namespace pbf::PBF_VARIANT
