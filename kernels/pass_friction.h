// Friction of walls and obstacles: the viscous force of fluid that goes on behind a surface and
// moves with it. kernels/README.md, "Friction".
#pragma once

#include "kernels/boundary/solid_scene.h"
#include "kernels/dissipation.h"
#include "kernels/params.h"
#include "kernels/rows.h"

namespace pbf::PBF_VARIANT {

/// The velocity of the place x of a solid, h/s.
template <class Real>
PBF_HD Vec3<Real> velocity_at(const SolidVelocity& s, Vec3<Real> x) {
  const Vec3<double> u{s.linear[0], s.linear[1], s.linear[2]},
      omega{s.angular[0], s.angular[1], s.angular[2]}, at{double(x.x), double(x.y), double(x.z)};
  const Vec3<double> v = u + cross(omega, at);
  return {Real(v.x), Real(v.y), Real(v.z)};
}

/// v -= s (v - u) along each surface, with its velocity u and s = friction C c F(q)/q, at most 1.
/// q is the distance in h and c the factor of the sweep before. Behind the surface the profile goes
/// on linearly, as in Takeda, Miyama & Sekiya 1994, Prog. Theor. Phys. 92, and Morris, Fox & Zhu
/// 1997, J. Comput. Phys. 136; here in closed form for a half space.
template <class Real, Smoothing S>
struct FrictionPass {
  Params<Real> p;
  Real strength = 0;      ///< C c
  Real of_wall[6] = {};   ///< friction of each, in the order of WallBit; 0 where there is none
  Bounds<Real> clear{};   ///< far from all walls
  Bounds<Real> bounds{};  ///< of all obstacles
  int obstacles = 0;      ///< 0: none has friction
  const SolidScene<Real>* solid_scene = nullptr;  ///< null: neither obstacles nor loads
  const Real* of_obstacle = nullptr;              ///< friction of each
  const SolidVelocity* solid_velocity = nullptr;  ///< null: none moves
  bool booked = false;                            ///< loads
  OwnRows<const Vec4<Real>> position;
  OwnRows<Vec4<Real>> velocity;  ///< in/out, h/s
  DissipationBook book;

  static constexpr int D = dimensions_of(S);

  PBF_HD void operator()(int i) const {
    const Vec3<Real> x = xyz(position[i]);
    const bool at_solids = obstacles > 0 && bounds.has(x);
    if (clear.has(x) && !at_solids) return;
    Vec3<Real> v = xyz(velocity[i]);
    double taken = 0;
    if (!clear.has(x)) along_walls(i, x, v, taken);
    if (at_solids) along_obstacles(i, x, v, taken);
    velocity[i] = with_w(v, Real(0));
    book.add(i, taken);
  }

 private:
  /// The share of the difference that a surface takes. q: on or behind it 0.
  PBF_HD Real share(Real friction, Real q) const {
    const Real part = friction * strength * first_moment<S>(max2(q, Real(0)));
    return part < q ? part / q : part > Real(0) ? Real(1) : Real(0);
  }
  PBF_HD void along(int surface, int i, Vec3<Real> x, Vec3<Real> normal, Vec3<Real> u, Real s,
                    Vec3<Real>& v, double& taken) const {
    const Vec3<Real> slip = v - u, tangential = slip - dot(slip, normal) * normal,
                     now = v - s * tangential;
    taken += energy_taken(slip, now - u);
    if (booked) solid_scene->loads.add(surface, i, x, p.dt * (now - v));
    v = now;
  }
  PBF_HD void along_walls(int i, Vec3<Real> x, Vec3<Real>& v, double& taken) const {
    const Vec3<Real> e = p.boundary.extent;
    const Real q[6] = {x.x, e.x - x.x, x.y, e.y - x.y, x.z, e.z - x.z};
    for (int wall = 0; wall < 6; ++wall) {
      if (!(of_wall[wall] > Real(0)) || !(q[wall] < Real(1))) continue;
      const Real at(1), none(0);
      const Vec3<Real> normal{wall / 2 == 0 ? at : none, wall / 2 == 1 ? at : none,
                              wall / 2 == 2 ? at : none};
      along(wall, i, x, normal, {}, share(of_wall[wall], q[wall]), v, taken);
    }
  }
  PBF_HD_RARE void along_obstacles(int i, Vec3<Real> x, Vec3<Real>& v, double& taken) const {
    for (int k = 0; k < obstacles; ++k) {
      const PosedSolid<Real>& o = solid_scene->solid[k];
      if (!(of_obstacle[k] > Real(0)) || !o.bounds.has(x)) continue;
      const Real q = distance<D>(o.solid, x);
      if (!(q < Real(1))) continue;
      const Vec3<Real> u = solid_velocity ? velocity_at(solid_velocity[k], x) : Vec3<Real>{};
      along(load_row_of_solid(k), i, x, normal<D>(o.solid, x), u, share(of_obstacle[k], q), v,
            taken);
    }
  }
};

}  // namespace pbf::PBF_VARIANT
