#include "lib/program/free_bodies.h"

#include <cmath>
#include <numbers>

#include "lib/scene/vector3.h"

namespace pbf::program_module {
namespace {

struct AxisAngle {
  Double3 axis{0, 0, 1};
  double degrees = 0;
};

/// Of the rotation that turns the axes of the scene into these rows; by its quaternion, from the
/// largest part of it (Shepperd 1978).
AxisAngle axis_angle(const Matrix3& rows) {
  const double trace = rows[0][0] + rows[1][1] + rows[2][2];
  const Double3 skew{rows[1][2] - rows[2][1], rows[2][0] - rows[0][2], rows[0][1] - rows[1][0]};
  std::size_t k = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (rows[a][a] > rows[k][k]) k = a;
  double real = 1 + trace;
  Double3 v = skew;
  if (trace < rows[k][k]) {
    real = skew[k];
    for (std::size_t a = 0; a < 3; ++a)
      v[a] = a == k ? 1 + 2 * rows[k][k] - trace : rows[a][k] + rows[k][a];
  }
  const double size = length(v);
  if (size < 1e-15 * std::fabs(real)) return {};
  for (double& x : v)
    if (std::fabs(x) < 1e-13 * size) x = 0;  // so that a turn about an axis of the scene stays one
  return {(1 / size) * v, 360 / std::numbers::pi * std::atan2(size, real)};
}

void begin_at(Obstacle& o, const BodyMotion& now) {
  const Double3 before = o.middle(), shift = now.middle - before;
  Matrix3 rows = o.axes();
  for (Double3& row : rows) row = times(now.turn, row);
  const auto moved = [&](const Double3& x) { return now.middle + times(now.turn, x - before); };
  std::visit(
      [&](auto& keys) {
        if constexpr (requires { keys.turn_axis; }) {
          const AxisAngle turn = axis_angle(rows);
          keys.turn_axis = turn.axis, keys.turn_angle = turn.degrees;
        }
        if constexpr (requires { keys.translate; }) keys.translate = moved(keys.translate);
        if constexpr (requires { keys.min; })
          keys.min = keys.min + shift, keys.max = keys.max + shift;
        if constexpr (requires { keys.center; }) keys.center = now.middle;
        if constexpr (requires { keys.from; })
          keys.from = moved(keys.from), keys.to = moved(keys.to);
      },
      o.shape);
  o.free->velocity = now.velocity;
  o.free->angular = (180 / std::numbers::pi) * now.spin;
  o.free->now.reset();
}

}  // namespace

Scene begun_with_bodies(Scene scene, const std::vector<BodyMotion>& bodies) {
  auto next = bodies.begin();
  for (Obstacle& o : scene.obstacles)
    if (o.free && next != bodies.end()) begin_at(o, *next++);
  return scene;
}

}  // namespace pbf::program_module
