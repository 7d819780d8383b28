#include "lib/program/motion.h"

#include <algorithm>
#include <cmath>

#include "lib/base/error.h"
#include "lib/program/motion_table.h"
#include "lib/program/motion_times.h"
#include "lib/scene/vector3.h"

namespace pbf::program_module {
namespace {

constexpr double kPi = 3.14159265358979323846, kRadians = kPi / 180;

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}
/// Rotation by `angle` (radians) about an axis of any length above 0.
Matrix3 turn_about(const Double3& axis, double angle) {
  if (angle == 0) return kUnit3;
  const Double3 u = unit(axis);
  Matrix3 m;
  for (std::size_t k = 0; k < 3; ++k) {
    const Double3 column = turned(kUnit3[k], u, angle);
    for (std::size_t i = 0; i < 3; ++i) m[i][k] = column[i];
  }
  return m;
}

/// amplitude * ramp * sine. At t < 0 a motion with a ramp is at rest; without one it is the sine.
double swing(const Swing& s, double t) {
  const double ramp = s.ramp.value_or(0);
  const double grown = ramp <= 0 || t >= ramp ? 1
                       : t <= 0               ? 0
                                              : 0.5 * (1 - std::cos(kPi * t / ramp));
  return s.amplitude * grown * std::sin(2 * kPi * t / s.period + s.phase * kRadians);
}

void must_be_read(const MotionTable& table, const std::string& path) {
  if (table.time.empty()) throw Error(ExitCode::internal, "the motion in " + path + " is not read");
}

}  // namespace

Double3 Pose::of(const Double3& x) const { return pivot + times(turn, x - pivot) + shift; }

std::int64_t prescribed_obstacles(const Scene& s) {
  return std::ranges::count_if(s.obstacles, [](const Obstacle& o) { return o.motion.has_value(); });
}

double size_of(const Scene& s, const Obstacle& o) {
  const double of_body =
      std::visit([](const auto& keys) { return size_of_shape<double>(keys.make(1)); }, o.shape);
  return std::min(length(s.domain.max - s.domain.min), of_body);
}

Pose pose_of(const Scene& s, const Obstacle& o, double time) {
  Pose p;
  if (o.free && o.free->now) {
    p.pivot = o.middle();
    p.turn = o.free->now->turn;
    p.shift = o.free->now->middle - p.pivot;
  }
  if (!o.motion) return p;
  const Motion& m = *o.motion;
  const double t = s.time.motion_begin + (m.waits ? 0 : time);
  p.pivot = m.pivot.value_or(o.middle());
  switch (m.kind) {
    case MotionKind::sine:
      if (m.direction)
        p.shift = swing(m, t) * unit(*m.direction);
      else
        p.turn = turn_about(*m.axis, swing(m, t) * kRadians);
      break;
    case MotionKind::velocity:
      p.shift = t * m.velocity;
      if (const double rate = length(m.angular); rate > 0)
        p.turn = turn_about(m.angular, t * rate * kRadians);
      break;
    default: {  // has_table(m)
      must_be_read(m.table, m.path);
      for (std::size_t k = 0; k < 3; ++k) p.shift[k] = cubic(m.table, k, t);
      if (m.table.columns < 6) break;
      for (std::size_t k = 0; k < 3; ++k)
        p.turn = product(turn_about(kUnit3[k], cubic(m.table, k + 3, t) * kRadians), p.turn);
      break;
    }
  }
  return p;
}

TankPose tank_pose(const Scene& s, double time) {
  const TankMotion& m = *s.tank_motion;
  const double t = s.time.motion_begin + time;
  if (m.kind == TankMotionKind::sine)
    return m.direction ? TankPose{0, swing(m, t) * unit(*m.direction)}
                       : TankPose{swing(m, t) * kRadians, {}};
  must_be_read(m.table, m.path);
  return m.table.columns == 1 ? TankPose{cubic(m.table, 0, t) * kRadians, {}} : TankPose{};
}

FrameStep<double> frame_step(const Scene& s, const Axes& axes, double time, double dt) {
  FrameStep<double> out;
  Matrix3 turn{}, pull{};
  Double3 push = dt * s.gravity, pivot = 0.5 * (s.domain.min + s.domain.max);
  if (s.tank_motion) {
    const TankMotion& m = *s.tank_motion;
    const TankPose before = tank_pose(s, time - dt), now = tank_pose(s, time),
                   behind = tank_pose(s, time + dt);
    if (m.pivot) pivot = *m.pivot;
    push = push - (1 / dt) * ((behind.shift - now.shift) - (now.shift - before.shift));
    if (m.kind == TankMotionKind::file && m.table.columns == 3)
      for (std::size_t k = 0; k < 3; ++k)
        push[k] -= dt * straight(m.table, k, s.time.motion_begin + time);
    if (m.axis) {
      const Matrix3 one = turn_about(*m.axis, now.angle - behind.angle),
                    two = turn_about(*m.axis, before.angle - behind.angle);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          turn[i][j] = two[i][j] - kUnit3[i][j];
          pull[i][j] = (2 * (one[i][j] - kUnit3[i][j]) - turn[i][j]) / dt;
        }
      push = times(turn_about(*m.axis, -behind.angle), push);
    }
  }
  for (int k = 0; k < 3; ++k) {
    const auto i = std::size_t(axes.of[k]);
    for (int l = 0; l < 3; ++l) {
      const auto j = std::size_t(axes.of[l]);
      out.turn[k][l] = turn[i][j];
      out.pull[k][l] = pull[i][j];
    }
  }
  for (double& x : push) x /= s.h();
  out.pivot = internal_place(s, axes, pivot);
  out.push = along_internal(axes, push);
  return out;
}

namespace {
/// m/s: upper bound of the speed of the points of a free body.
double speed_of(const Scene& s, const Obstacle& o) {
  const BodyMotion now =
      o.free->now.value_or(BodyMotion{{}, kUnit3, o.free->velocity, kRadians * o.free->angular});
  return length(now.velocity) + length(now.spin) * size_of(s, o);
}
}  // namespace

double fastest_obstacle(const Scene& s, double from, double to) {
  double fastest = 0;
  const double dt = 1e-3 * s.time.step;
  for (const Obstacle& o : s.obstacles) {
    if (o.free) fastest = std::max(fastest, speed_of(s, o));
    if (!o.motion) continue;
    for (const double t : telling_times(s, *o.motion, from, to)) {
      const Pose a = pose_of(s, o, t), b = pose_of(s, o, t + dt);
      const Double3 middle = o.middle();
      double turned = 0;  // squared displacement of the ends of three unit axes
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) turned += std::pow(b.turn[i][j] - a.turn[i][j], 2);
      fastest = std::max(
          fastest,
          (length(b.of(middle) - a.of(middle)) + std::sqrt(turned / 2) * size_of(s, o)) / dt);
    }
  }
  return fastest;
}

double greatest_pull(const Scene& s, double from, double to) {
  double most = length(s.gravity);
  if (!s.tank_motion) return most;
  const double h = s.h(), dt = s.time.step;
  for (const double t : telling_times(s, *s.tank_motion, from, to)) {
    const FrameStep<double> f = frame_step(s, {}, t, dt);
    for (int corner = 0; corner < 8; ++corner) {
      const auto at = [&](int k) {
        return corner >> k & 1 ? (s.domain.max[std::size_t(k)] - s.domain.min[std::size_t(k)]) / h
                               : 0.0;
      };
      const Vec3<double> v =
          f.accelerated({at(0), s.plane() ? 0.0 : at(1), at(2)}, {0.0, 0.0, 0.0});
      most = std::max(most, h / dt * std::sqrt(dot(v, v)));
    }
  }
  return most;
}

double greatest_sway(const Scene& s, double from, double to) {
  double most = 0;
  if (!s.tank_motion) return most;
  const double h = s.h(), dt = s.time.step;
  const Double3 middle = (0.5 / h) * (s.domain.max - s.domain.min), g = (dt / h) * s.gravity;
  for (const double t : telling_times(s, *s.tank_motion, from, to)) {
    const FrameStep<double> f = frame_step(s, {}, t, dt);
    const Vec3<double> v =
        f.accelerated({middle[0], s.plane() ? 0.0 : middle[1], middle[2]}, {0.0, 0.0, 0.0});
    most = std::max(most, h / dt * length(Double3{v.x, v.y, v.z} - g));
  }
  return most;
}

}  // namespace pbf::program_module
