// Bodies that the fluid moves. Lengths in h, along the internal axes; masses in masses of a
// particle.
#pragma once

#include "kernels/boundary/loads.h"
#include "kernels/boundary/obstacle.h"

namespace pbf {

/// The position of a body's center of mass, and its rotation from the pose in the scene, as a
/// quaternion w, x, y, z.
struct BodyPose {
  double center[3] = {0, 0, 0};  ///< h, from the domain's lower corner
  double turn[4] = {1, 0, 0, 0};
};

/// What does not change. Arrays of three are along the internal axes, at the pose in the scene.
struct BodyKind {
  int solid = 0;  ///< number of the obstacle
  double mass = 1;
  double inertia[3][3] = {};        ///< h^2, about the center of mass
  double middle[3] = {0, 0, 0};     ///< h, Solid::center from the center of mass
  double axes[3][3] = {};           ///< Solid::turn
  double radius = 0;                ///< h, largest distance of its points from the center of mass
  bool held[3] = {}, kept[3] = {};  ///< along and about which axes it does not move
};

/// How a body answers impulses: 1 over its mass and its inertia, without the motions that are kept
/// from it.
struct BodyInverse {
  double mass[3] = {};        ///< per axis
  double inertia[3][3] = {};  ///< 1/h^2, symmetric
};

/// A free body after a substep.
struct BodyState {
  BodyPose at;
  double velocity[3] = {0, 0, 0};   ///< h/s, of the center of mass
  double spin[3] = {0, 0, 0};       ///< h^2/s, angular momentum about it
  double owed[3] = {0, 0, 0};       ///< h/s, impulse that it has not yet taken
  double owed_spin[3] = {0, 0, 0};  ///< h^2/s, the same of the spin
  double added = 0;                 ///< mass of the fluid that moves with it
  double added_inertia = 0;         ///< h^2, of the fluid that turns with it
  double energy = 0;                ///< h^2/s^2, kinetic and potential, after the update

  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    for (auto& x : s.at.center) f(x);
    for (auto& x : s.at.turn) f(x);
    for (auto& x : s.velocity) f(x);
    for (auto& x : s.spin) f(x);
    for (auto& x : s.owed) f(x);
    for (auto& x : s.owed_spin) f(x);
    f(s.added), f(s.added_inertia), f(s.energy);
  }
};

}  // namespace pbf

namespace pbf::PBF_VARIANT {

PBF_HD Vec3<double> times(const double (&m)[3][3], Vec3<double> a) {
  return {dot(vec(m[0]), a), dot(vec(m[1]), a), dot(vec(m[2]), a)};
}
PBF_HD Vec3<double> times_transposed(const double (&m)[3][3], Vec3<double> a) {
  return a.x * vec(m[0]) + a.y * vec(m[1]) + a.z * vec(m[2]);
}
/// Without the components that are held.
PBF_HD Vec3<double> without(const bool (&held)[3], Vec3<double> a) {
  return {held[0] ? 0 : a.x, held[1] ? 0 : a.y, held[2] ? 0 : a.z};
}

/// The rotation of a unit quaternion, as rows.
struct BodyTurn {
  double row[3][3];
  PBF_HD explicit BodyTurn(const double (&q)[4]) {
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    row[0][0] = 1 - 2 * (y * y + z * z), row[0][1] = 2 * (x * y - w * z);
    row[0][2] = 2 * (x * z + w * y), row[1][0] = 2 * (x * y + w * z);
    row[1][1] = 1 - 2 * (x * x + z * z), row[1][2] = 2 * (y * z - w * x);
    row[2][0] = 2 * (x * z - w * y), row[2][1] = 2 * (y * z + w * x);
    row[2][2] = 1 - 2 * (x * x + y * y);
  }
  PBF_HD Vec3<double> of(Vec3<double> a) const { return times(row, a); }
};

/// At a turn from the pose in the scene.
PBF_HD_APART BodyInverse inverse_of(const BodyKind& b, const BodyTurn& turn) {
  BodyInverse out;
  double in[3][3], half[3][3];
  for (int i = 0; i < 3; ++i) {
    out.mass[i] = b.held[i] ? 0 : 1 / b.mass;
    put(half[i], times_transposed(b.inertia, vec(turn.row[i])));  // rows of R I: I is symmetric
  }
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      in[i][k] = b.kept[i] || b.kept[k] ? (i == k ? 1 : 0) : dot(vec(half[i]), vec(turn.row[k]));
  const Vec3<double> x = vec(in[0]), y = vec(in[1]), z = vec(in[2]);
  const Vec3<double> a = cross(y, z), c = cross(z, x), d = cross(x, y);
  const double scale = 1 / dot(x, a);
  put(out.inertia[0], {scale * a.x, scale * c.x, scale * d.x});
  put(out.inertia[1], {scale * a.y, scale * c.y, scale * d.y});
  put(out.inertia[2], {scale * a.z, scale * c.z, scale * d.z});
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (b.kept[i] || b.kept[k]) out.inertia[i][k] = 0;
  return out;
}
/// h/s, of the center of mass.
PBF_HD Vec3<double> velocity_by(const BodyInverse& of, Vec3<double> impulse) {
  return {of.mass[0] * impulse.x, of.mass[1] * impulse.y, of.mass[2] * impulse.z};
}
/// 1/s, about the center of mass.
PBF_HD Vec3<double> rate_by(const BodyInverse& of, Vec3<double> spin) {
  return times(of.inertia, spin);
}

/// The pose after `dt` at these velocities. The angle is right to third order in a step, the axis
/// to rounding.
PBF_HD BodyPose moved(const BodyPose& from, Vec3<double> velocity, Vec3<double> rate, double dt) {
  BodyPose to;
  put(to.center, vec(from.center) + dt * velocity);
  const double half = 0.5 * dt, w = from.turn[0];
  const Vec3<double> q{from.turn[1], from.turn[2], from.turn[3]};
  const Vec3<double> next = q + half * (w * rate + cross(rate, q));
  const double real = w - half * dot(rate, q);
  const double size = 1 / square_root(real * real + dot(next, next));
  to.turn[0] = size * real, to.turn[1] = size * next.x;
  to.turn[2] = size * next.y, to.turn[3] = size * next.z;
  return to;
}

/// The frame of its solid at a pose: the same bits wherever it is asked for.
template <class Real>
PBF_HD_APART BodyFrame<Real> frame_at(const BodyKind& b, const BodyPose& pose) {
  const BodyTurn turn(pose.turn);
  BodyFrame<Real> out;
  const Vec3<double> c = vec(pose.center) + turn.of(vec(b.middle));
  out.center = {Real(c.x), Real(c.y), Real(c.z)};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3<double> along = turn.of(vec(b.axes[axis]));
    out.turn[axis][0] = Real(along.x), out.turn[axis][1] = Real(along.y);
    out.turn[axis][2] = Real(along.z);
  }
  return out;
}

/// The added mass and inertia over those of the particles that are pushed. From 1 on, what a single
/// particle gives to a body turns their approach at most into as fast a retreat, however light the
/// body is and wherever it is hit: 1/(m + c) + r^2/(I + c r^2) <= 2/c in masses of a particle.
constexpr double kAddedShare = 1;
/// They fall by no more than this factor in an iteration: particles that are not pushed in one
/// iteration are pushed again in a later one.
constexpr double kAddedKept = 0.9;

/// The body takes m/(m + a) of what it is owed, with the added mass a, and the rest later: fluid
/// that moves along with a body has to be moved by the same impulse; the same of turns. Without
/// this, bodies lighter than the fluid gain energy without limit (added-mass instability of
/// explicit coupling; Causin, Gerbeau & Nobile 2005). part: of this share. What is owed along axes
/// that do not move is lost to them.
PBF_HD void follow(const BodyKind& b, const BodyInverse& inverse, BodyState& s, double part) {
  const Vec3<double> owed = without(b.held, vec(s.owed));
  const Vec3<double> turn = without(b.kept, vec(s.owed_spin));
  const double squared = dot(turn, turn);
  const double ease = squared > 0 ? dot(turn, rate_by(inverse, turn)) / squared : 0;
  const double share = part * b.mass / (b.mass + s.added);
  const double turning = part / (1 + ease * s.added_inertia);
  put(s.velocity, vec(s.velocity) + velocity_by(inverse, share * owed));
  put(s.spin, vec(s.spin) + turning * turn);
  put(s.owed, (1 - share) * owed);
  put(s.owed_spin, (1 - turning) * turn);
}

/// h^2/s^2, kinetic and potential.
PBF_HD double energy_of(const BodyKind& b, const BodyState& s, Vec3<double> gravity) {
  const BodyTurn turn(s.at.turn);
  const Vec3<double> v = vec(s.velocity), l = vec(s.spin);
  return 0.5 * (b.mass * dot(v, v) + dot(l, rate_by(inverse_of(b, turn), l))) -
         b.mass * dot(gravity, vec(s.at.center));
}

}  // namespace pbf::PBF_VARIANT
