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

/// Numbers of particles: those whose density a free body may push, and those that it stops.
struct Sharers {
  double pushed = 0, stopped = 0;
};

/// The same as they are counted in an iteration.
struct SharerSums {
  std::int64_t pushed = 0, stopped = 0;
};

/// What a particle meets of a free body: each of those that meet it at once has a share of its mass
/// and of its inertia (mass splitting; Tonge, Benevolenski & Voroshilov 2012).
struct BodyShare {
  double center[3] = {0, 0, 0};  ///< h, of mass
  BodyInverse inverse;
  Sharers among;      ///< at least 1
  bool free = false;  ///< false: the solid does not give way
};

/// A free body after a substep.
struct BodyState {
  BodyPose at;
  double velocity[3] = {0, 0, 0};   ///< h/s, of the center of mass
  double spin[3] = {0, 0, 0};       ///< h^2/s, angular momentum about it
  double owed[3] = {0, 0, 0};       ///< h/s, impulse that it has not yet taken
  double owed_spin[3] = {0, 0, 0};  ///< h^2/s, the same of the spin
  Sharers among;                    ///< as many particles it is split among
  double energy = 0;                ///< h^2/s^2, kinetic and potential, after the update

  template <class Self, class F>
  static constexpr void each(Self& s, F&& f) {
    for (auto& x : s.at.center) f(x);
    for (auto& x : s.at.turn) f(x);
    for (auto& x : s.velocity) f(x);
    for (auto& x : s.spin) f(x);
    for (auto& x : s.owed) f(x);
    for (auto& x : s.owed_spin) f(x);
    f(s.among.pushed), f(s.among.stopped), f(s.energy);
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
PBF_HD BodyInverse inverse_of(const BodyKind& b, const BodyTurn& turn) {
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

/// |way|^2 over the mass with which a body takes part in a push along `way` at x.
PBF_HD double ease_of(const BodyShare& of, Vec3<double> x, Vec3<double> way) {
  const Vec3<double> turn = cross(x - vec(of.center), way);
  return dot(way, velocity_by(of.inverse, way)) + dot(turn, rate_by(of.inverse, turn));
}

/// The number of particles among which a body is split falls by no more than this factor in an
/// iteration: those that do not meet it in one meet it again in a later one.
constexpr double kSharersKept = 0.5;
/// h: at most so far is a particle moved out of a free body without becoming faster. What it is
/// still behind the surface, it makes in a later iteration.
constexpr double kMostStill = 0.05;

/// The body takes `part` of what it is owed. What is owed along axes that do not move is lost to
/// them.
PBF_HD void follow(const BodyKind& b, const BodyInverse& inverse, BodyState& s, double part) {
  const Vec3<double> owed = without(b.held, vec(s.owed));
  const Vec3<double> turn = without(b.kept, vec(s.owed_spin));
  put(s.velocity, vec(s.velocity) + velocity_by(inverse, part * owed));
  put(s.spin, vec(s.spin) + part * turn);
  put(s.owed, (1 - part) * owed);
  put(s.owed_spin, (1 - part) * turn);
}

/// h^2/s^2, kinetic and potential.
PBF_HD double energy_of(const BodyKind& b, const BodyState& s, Vec3<double> gravity) {
  const BodyTurn turn(s.at.turn);
  const Vec3<double> v = vec(s.velocity), l = vec(s.spin);
  return 0.5 * (b.mass * dot(v, v) + dot(l, rate_by(inverse_of(b, turn), l))) -
         b.mass * dot(gravity, vec(s.at.center));
}

}  // namespace pbf::PBF_VARIANT
