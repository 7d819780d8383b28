// The walls of a domain with what else a scene has there: obstacles, and loads on all of them.
#pragma once

#include "kernels/boundary/keep_out.h"
#include "kernels/boundary/loads.h"
#include "kernels/boundary/solid_term.h"

namespace pbf::inline PBF_VARIANT {

/// An obstacle and the box, h, beyond which it adds nothing to the density.
template <class Real>
struct PlacedSolid {
  Solid<Real> solid;
  Vec3<Real> low, high;

  /// Whether the box meets that around two places.
  PBF_HD bool near(Vec3<Real> a, Vec3<Real> b) const {
    return min2(a.x, b.x) <= high.x && max2(a.x, b.x) >= low.x && min2(a.y, b.y) <= high.y &&
           max2(a.y, b.y) >= low.y && min2(a.z, b.z) <= high.z && max2(a.z, b.z) >= low.z;
  }
};

/// Answers as a box does, with obstacles in it. Loads are booked on the walls, 0 to 5 as WallBit's
/// bits, and on the obstacles, from 6 on.
template <class Real>
struct Solids : Box<Real> {
  static constexpr bool books = true;
  LoadBook<Real> loads{};
  const PlacedSolid<Real>* solid = nullptr;
  int count = 0;
  bool flat = false;        ///< two dimensions
  PlacedSolid<Real> all{};  ///< the box around all of them

  /// Solids share the space with the walls by inclusion and exclusion, and do not overlap each
  /// other: A [1 - (1 - w/A)(1 - sum o_k)].
  template <Smoothing S>
  PBF_HD BoundaryTerm<Real> term(Vec3<Real> x) const {
    BoundaryTerm<Real> w = Box<Real>::template term<S>(x);
    if (!near_any(x, x) || !this->adds_density) return w;
    SolidTerm<Real> o;
    for_near<S>(x, [&](int, const SolidTerm<Real>& one) {
      o.share += one.share;
      o.gradient = o.gradient + one.gradient;
    });
    const Real free = max2(Real(1) - o.share, Real(0)), left = this->scale - w.density;
    const Real still = o.share < Real(1) ? left : Real(0);
    w.gradient = free * w.gradient + still * o.gradient;
    w.density = this->scale - left * free;
    return w;
  }

  PBF_HD double penetration(const double (&x)[3]) const {
    double deepest = Box<Real>::penetration(x);
    const Vec3<Real> at{Real(x[0]), Real(x[1]), Real(x[2])};
    if (!near_any(at, at)) return deepest;
    for (int k = 0; k < count; ++k)
      if (solid[k].near(at, at)) {
        const Solid<Real>& s = solid[k].solid;
        deepest = max2(deepest, -double(flat ? distance<2>(s, at) : distance<3>(s, at)));
      }
    return deepest;
  }

  PBF_HD Vec3<Real> path_end(Vec3<Real> from, Vec3<Real> to) const {
    return path_end(from, to, [](int, int, Real) {});
  }
  /// booked(wall, axis, way): by how much a wall or an obstacle has moved the end of the path.
  template <class F>
  PBF_HD Vec3<Real> path_end(Vec3<Real> from, Vec3<Real> to, F&& booked) const {
    to = inside_walls(from, to, booked);
    if (!near_any(from, to)) return to;
    // What slides along one obstacle may come to another, or to a wall.
    for (int round = 0; round < 3; ++round) {
      bool moved = false;
      for (int k = 0; k < count; ++k) {
        if (!solid[k].near(from, to)) continue;
        const PathEnd<Real> end =
            flat ? keep_out<2>(solid[k].solid, from, to) : keep_out<3>(solid[k].solid, from, to);
        if (!end.hit) continue;
        moved = true;
        const Vec3<Real> at = inside_walls(from, end.x, booked);
        book_way(6 + k, end.x - to, booked);
        to = at;
      }
      if (!moved) return to;
    }
    for (int k = 0; k < count; ++k)  // wedged in: it stays where it was
      if (solid[k].near(from, to) &&
          (flat ? keep_out<2>(solid[k].solid, from, to) : keep_out<3>(solid[k].solid, from, to))
              .hit) {
        book_way(6 + k, from - to, booked);
        return from;
      }
    return to;
  }

  /// Particle i, at x, was moved by factor * the gradient of term().
  template <Smoothing S>
  PBF_HD void book_push(int i, Vec3<Real> x, Real factor) const {
    if (!loads.sums || factor == Real(0) || !this->adds_density) return;
    Real of_wall[6], share(0);
    const bool at_wall = this->template slopes<S>(x, of_wall), at_solid = near_any(x, x);
    if (at_solid) {
      const Real left = this->scale - Box<Real>::template term<S>(x).density;
      for_near<S>(x, [&](int, const SolidTerm<Real>& one) { share += one.share; });
      if (share < Real(1))
        for_near<S>(x, [&](int k, const SolidTerm<Real>& one) {
          const Vec3<Real> way = (factor * left) * one.gradient;
          book_way(6 + k, way, [&](int wall, int axis, Real w) { loads.add(wall, i, x, axis, w); });
        });
    }
    const Real free = max2(Real(1) - share, Real(0));
    for (int wall = 0; at_wall && wall < 6; ++wall)
      if (of_wall[wall] != Real(0)) loads.add(wall, i, x, wall / 2, factor * free * of_wall[wall]);
  }
  /// path_end() of particle i, booked.
  PBF_HD Vec3<Real> held(int i, Vec3<Real> from, Vec3<Real> to) const {
    if (!loads.sums) return path_end(from, to);
    return path_end(from, to,
                    [&](int wall, int axis, Real way) { loads.add(wall, i, to, axis, way); });
  }

 private:
  PBF_HD bool near_any(Vec3<Real> a, Vec3<Real> b) const { return count > 0 && all.near(a, b); }
  template <Smoothing S, class F>
  PBF_HD void for_near(Vec3<Real> x, F&& f) const {
    for (int k = 0; k < count; ++k)
      if (solid[k].near(x, x)) f(k, solid_term<S>(solid[k].solid, x, this->inv_range));
  }
  template <class F>
  PBF_HD static void book_way(int wall, Vec3<Real> way, F&& booked) {
    if (way.x != Real(0)) booked(wall, 0, way.x);
    if (way.y != Real(0)) booked(wall, 1, way.y);
    if (way.z != Real(0)) booked(wall, 2, way.z);
  }
  template <class F>
  PBF_HD Vec3<Real> inside_walls(Vec3<Real> from, Vec3<Real> to, F&& booked) const {
    const Vec3<Real> in = Box<Real>::path_end(from, to), way = in - to;
    if (way.x != Real(0)) booked(way.x < Real(0) ? 1 : 0, 0, way.x);
    if (way.y != Real(0)) booked(way.y < Real(0) ? 3 : 2, 1, way.y);
    if (way.z != Real(0)) booked(way.z < Real(0) ? 5 : 4, 2, way.z);
    return in;
  }
};

}  // namespace pbf::inline PBF_VARIANT
