// Contacts of free bodies with walls, obstacles and each other: no bounce and no friction. A body
// stops where it would go through something in a substep (sequential impulses, Catto 2006).
#pragma once

#include "kernels/boundary/free_body.h"
#include "kernels/boundary/solid_scene.h"

namespace pbf {

/// A point of a body's surface, in the axes of Solid::turn, from Solid::center; h.
struct ContactSpot {
  double at[3] = {0, 0, 0};
  double radius = 0;  ///< h, of a ball about it that belongs to the body
};
/// Those of a solid. radius: largest distance of its points from Solid::center, h.
struct SolidSpots {
  int first = 0, count = 0, body = -1;  ///< body: its number among the free ones; -1: not free
  double radius = 0;
};

/// A place where a body may touch something in a substep.
struct Contact {
  int other = -1;             ///< the other body; -1: what it touches moves as prescribed
  double arm[3] = {0, 0, 0};  ///< h, from the center of mass at the start of the substep
  double other_arm[3] = {0, 0, 0};
  double normal[3] = {0, 0, 0};  ///< out of the other one
  double gap = 0;                ///< h, at the start of the substep
  double speed = 0;              ///< h/s, of a prescribed surface along the normal
  double impulse = 0;            ///< h/s
};

inline constexpr int kMostContacts = 32;  ///< of a body; of more, those with the least gaps count

/// A free body within a substep.
struct BodyStep {
  BodyPose start;                         ///< at its start
  BodyInverse inverse;                    ///< there
  double velocity[3] = {}, rate[3] = {};  ///< h/s, 1/s; as predicted
  LoadSums seen;                          ///< of the sums of this update
  int contacts = 0;
  Contact contact[kMostContacts];
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

/// Rounds over the contacts of all bodies.
constexpr int kContactRounds = 24;
/// Share of an overlap that a substep removes, and h: at most so much. Between two things that come
/// together there is no room for a body, which would be thrown to and fro.
constexpr double kOverlapShare = 0.2, kOverlapMost = 0.005;

/// Everything that contacts are found with.
template <class Real>
struct ContactScene {
  const BodyKind* body = nullptr;
  const BodyState* state = nullptr;
  const ContactSpot* spot = nullptr;
  const SolidSpots* solid = nullptr;
  const PosedSolid<Real>* placed = nullptr;  ///< free bodies at the start of the substep
  const Solid<Real>* before = nullptr;       ///< of those with a prescribed motion
  const SolidVelocity* velocity = nullptr;
  int solids = 0;
  Box<Real> walls;
  bool flat = false;

  /// Where a solid is at the start of the substep.
  PBF_HD const Solid<Real>& at_start(int k) const {
    return solid[k].body < 0 && velocity[k].moves ? before[k] : placed[k].solid;
  }
  /// Fills step.contact for body b. dt: of the substep. room: how much farther than predicted it
  /// may move, h.
  PBF_HD_APART void find(int b, BodyStep& step, Vec3<double> rate, double dt, double room) const {
    const BodyKind& own = body[b];
    const Solid<Real>& me = placed[own.solid].solid;
    const Vec3<double> center = vec(step.start.center), v = vec(state[b].velocity);
    const double way = dt * (square_root(dot(v, v)) + own.radius * square_root(dot(rate, rate)));
    const double margin = 2 * way + room;
    const SolidSpots& mine = solid[own.solid];
    step.contacts = 0;
    for (int i = 0; i < mine.count; ++i) {
      const ContactSpot& s = spot[mine.first + i];
      const Vec3<double> x = place(me, s);
      with_walls(step, x, x - center, s.radius, margin);
    }
    for (int k = 0; k < solids; ++k) {
      if (k == own.solid) continue;
      const SolidSpots& other = solid[k];
      const int body_k = other.body;
      if (body_k >= 0 && body_k < b) continue;  // found by the other one
      const Solid<Real>& it = at_start(k);
      const Vec3<double> apart = in_double(me.center) - in_double(it.center);
      const double reach =
          mine.radius + other.radius + margin + (body_k >= 0 || velocity[k].moves ? margin : 0);
      if (dot(apart, apart) > reach * reach) continue;
      for (int i = 0; i < mine.count; ++i) {
        const ContactSpot& s = spot[mine.first + i];
        const Vec3<double> x = place(me, s);
        with_solid(step, k, it, x, center, s.radius, 1, margin);
      }
      for (int i = 0; i < other.count; ++i) {
        const ContactSpot& s = spot[other.first + i];
        const Vec3<double> x = place(it, s);
        with_solid(step, k, me, x, center, s.radius, -1, margin);
      }
    }
  }

 private:
  PBF_HD static Vec3<Real> narrow(Vec3<double> a) { return {Real(a.x), Real(a.y), Real(a.z)}; }
  PBF_HD Vec3<double> place(const Solid<Real>& o, const ContactSpot& s) const {
    const Vec3<Real> at = narrow(vec(s.at));
    return in_double(o.center + (flat ? turned_back<2>(o, at) : turned_back<3>(o, at)));
  }
  PBF_HD static void add(BodyStep& step, const Contact& c) {
    int at = step.contacts;
    if (at < kMostContacts) {
      ++step.contacts;
    } else {
      at = 0;
      for (int i = 1; i < kMostContacts; ++i)
        if (step.contact[i].gap > step.contact[at].gap) at = i;
      if (step.contact[at].gap <= c.gap) return;
    }
    step.contact[at] = c;
  }
  PBF_HD void with_walls(BodyStep& step, Vec3<double> x, Vec3<double> arm, double radius,
                         double margin) const {
    const double at[3] = {x.x, x.y, x.z};
    const double end[3] = {double(walls.extent.x), double(walls.extent.y), double(walls.extent.z)};
    for (int wall = 0; wall < 6; ++wall) {
      if (!(walls.walls >> wall & 1u) || (flat && wall / 2 == 1)) continue;
      Contact c;
      c.gap = (wall % 2 ? end[wall / 2] - at[wall / 2] : at[wall / 2]) - radius;
      if (!(c.gap < margin)) continue;
      c.normal[wall / 2] = wall % 2 ? -1 : 1;
      put(c.arm, arm - radius * vec(c.normal));
      add(step, c);
    }
  }
  /// x: a point of the body (side 1) or of solid k (side -1), and `o` the other one of the two.
  PBF_HD void with_solid(BodyStep& step, int k, const Solid<Real>& o, Vec3<double> x,
                         Vec3<double> center, double radius, double side, double margin) const {
    const Vec3<Real> p = narrow(x);
    const double away = double(flat ? distance<2>(o, p) : distance<3>(o, p)) - radius;
    if (!(away < 2 * margin)) return;
    Contact c;
    const Vec3<double> out = in_double(flat ? normal<2>(o, p) : normal<3>(o, p));
    const Vec3<double> at = x - radius * out;
    c.gap = away;
    c.other = solid[k].body;
    put(c.normal, side * out);
    put(c.arm, at - center);
    if (c.other >= 0) {
      put(c.other_arm, at - vec(state[c.other].at.center));
    } else if (velocity[k].moves) {
      const SolidVelocity& u = velocity[k];
      c.speed = dot(vec(c.normal), vec(u.linear) + cross(vec(u.angular), at));
    }
    add(step, c);
  }
};

/// Gives bodies the impulses that keep them apart in a substep of length dt. Keeps their sums, so
/// that it may be called again after velocities have changed.
PBF_HD void solve_contacts(const BodyKind* body, BodyState* state, BodyStep* step, int bodies,
                           double dt) {
  const auto push = [&](int b, Vec3<double> arm, Vec3<double> impulse) {
    put(state[b].velocity, vec(state[b].velocity) + velocity_by(step[b].inverse, impulse));
    put(state[b].spin, vec(state[b].spin) + without(body[b].kept, cross(arm, impulse)));
  };
  const auto speed_at = [&](int b, Vec3<double> arm) {
    return vec(state[b].velocity) + cross(rate_by(step[b].inverse, vec(state[b].spin)), arm);
  };
  const auto answer = [&](int b, Vec3<double> arm, Vec3<double> n) {
    const Vec3<double> turn = cross(arm, n);
    return dot(n, velocity_by(step[b].inverse, n)) + dot(turn, rate_by(step[b].inverse, turn));
  };
  for (int round = 0; round < kContactRounds; ++round) {
    bool changed = false;
    for (int b = 0; b < bodies; ++b) {
      for (int i = 0; i < step[b].contacts; ++i) {
        Contact& c = step[b].contact[i];
        const Vec3<double> n = vec(c.normal), arm = vec(c.arm), other_arm = vec(c.other_arm);
        double speed = dot(n, speed_at(b, arm)) - c.speed, ease = answer(b, arm, n);
        const int k = c.other;
        if (k >= 0) {
          speed -= dot(n, speed_at(k, other_arm));
          ease += answer(k, other_arm, n);
        }
        if (!(ease > 0)) continue;
        const double allowed =
            -(c.gap > 0 ? c.gap : max2(kOverlapShare * c.gap, -kOverlapMost)) / dt;
        const double sum = max2(c.impulse + (allowed - speed) / ease, 0.0);
        const double more = sum - c.impulse;
        if (more == 0) continue;
        changed = true;
        c.impulse = sum;
        push(b, arm, more * n);
        if (k >= 0) push(k, other_arm, -more * n);
      }
    }
    if (!changed) return;
  }
}

}  // namespace pbf::PBF_VARIANT
