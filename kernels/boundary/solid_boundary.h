// The boundary of scenes with obstacles or loads.
#pragma once

#include "kernels/boundary/near_rows.h"
#include "kernels/boundary/solid_scene.h"

namespace pbf::PBF_VARIANT {

/// A box that also evaluates the solids and loads of its scene.
template <class Real>
struct SolidBoundary : Box<Real> {
  static constexpr bool books = true;
  const SolidScene<Real>* solid_scene = nullptr;
  Bounds<Real> bounds{};                   ///< of all obstacles
  Bounds<Real> clear{};                    ///< far from all walls
  bool obstacles = false;                  ///< whether there are any
  bool loaded = false;                     ///< whether walls have loads
  bool booked = false;                     ///< whether loads are booked: in steps with time
  const FrameStep<Real>* frame = nullptr;  ///< of the step; null: the tank is at rest
  NearRows<Real> near{};                   ///< empty without obstacles and loads

  template <Smoothing S>
  PBF_HD BoundaryTerm<Real> term(Vec3<Real> x) const {
    if (obstacles && bounds.has(x)) return solid_scene_term<S>(*solid_scene, x);
    return Box<Real>::template term<S>(x);
  }
  template <Smoothing S, class Step>
  PBF_HD Vec3<Real> push_gradient(Vec3<Real> x, const Step& step) const {
    if (obstacles && bounds.has(x)) return solid_scene_term<S>(*solid_scene, x, step).gradient;
    return Box<Real>::template push_gradient<S>(x, step);
  }
  /// The end of a path of particle i. `book`: loads of walls and solids are booked. `start`: the
  /// path begins with the step.
  PBF_HD Stop<Real> path_end(bool book, bool start, int i, Vec3<Real> from, Vec3<Real> to) const {
    const Vec3<Real> in = Box<Real>::path_end(from, to);
    const bool free = in.x == to.x && in.y == to.y && in.z == to.z;
    if ((free || !book) && !(obstacles && bounds.meets(from, to))) return {in};
    return solid_scene_path_end(*solid_scene, book, start, i, from, to);
  }
  PBF_HD Stop<Real> path_end_booked(int i, Vec3<Real> from, Vec3<Real> to) const {
    return path_end(booked, false, i, from, to);
  }
  /// Books that particle i, at x, was moved by factor * push_gradient().
  template <Smoothing S, class Step>
  PBF_HD void book_push(int i, Vec3<Real> x, const Step& step, Real factor) const {
    if (!booked || factor == Real(0)) return;
    if ((loaded && this->near_wall(x)) || (obstacles && bounds.has(x)))
      pbf::book_push<S>(*solid_scene, i, x, step, factor);
  }
  /// What free bodies add to the divisor of lambda.
  template <Smoothing S>
  PBF_HD Real ease(int i, Vec3<Real> x) const {
    if (!booked || !obstacles || !solid_scene->share || !bounds.has(x)) return Real(0);
    return ease_of_bodies<S>(*solid_scene, i, x);
  }
  /// Whether x is near an obstacle, or near a wall if walls have loads.
  PBF_HD bool is_near(Vec3<Real> x) const {
    return (loaded && !clear.has(x)) ||
           (obstacles && bounds.has(x) && near_obstacle(*solid_scene, x));
  }
  /// Marks row i as near if x, its position after a move with the present lists, is near.
  PBF_HD void came_to(int i, Vec3<Real> x) const {
    if (near.way_left_squared && !near.near(i) && is_near(x)) near.mark_near(i);
  }
  PBF_HD double penetration(const double (&x)[3]) const {
    double deepest = Box<Real>::penetration(x);
    const Vec3<Real> at{Real(x[0]), Real(x[1]), Real(x[2])};
    if (!obstacles || !bounds.has(at)) return deepest;
    const SolidScene<Real>& all = *solid_scene;
    const auto away = [&](int k) {
      return double(all.flat ? distance<2>(all.solid[k].solid, at)
                             : distance<3>(all.solid[k].solid, at));
    };
    for (int k = 0; k < all.solids; ++k) {
      if (!all.solid[k].bounds.has(at)) continue;
      double depth = -away(k);
      if (depth > deepest && k >= all.obstacles()) depth = min2(depth, away(k + all.casings));
      deepest = max2(deepest, depth);
    }
    return deepest;
  }
};

/// Whether a path may meet a solid or end near one; for SolidBoundary and FarBoundary.
template <class Boundary, class Real>
PBF_HD bool may_meet_solids(const Boundary& b, Vec3<Real> from, Vec3<Real> to) {
  return (b.loaded && !b.clear.has(to)) || (b.obstacles && b.bounds.meets(from, to));
}

}  // namespace pbf::PBF_VARIANT
