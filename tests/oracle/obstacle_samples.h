// Obstacles of every shape, each with a convex function of its own that is below 0 inside.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "kernels/boundary/box.h"
#include "kernels/boundary/solid_term.h"
#include "tests/oracle/solid_quadrature.h"
#include "tests/support/obstacle_shapes.h"

namespace oracle_test {

using pbf_test::ObstacleShape;

/// Lengths of a body, h. box: half edges. cylinder, capsule: z = half the length of the axis, x =
/// radius. sphere: x = radius.
struct SampleBody {
  ObstacleShape shape = ObstacleShape::box;
  pbf::Vec3<double> half;
  unsigned through = 0;

  pbf::SomeShape<double> kernels() const {
    switch (shape) {
      case ObstacleShape::plane:
        return pbf::shape::Plane<double>{};
      case ObstacleShape::sphere:
        return pbf::shape::Sphere<double>{half.x};
      case ObstacleShape::cylinder:
        return pbf::shape::Cylinder<double>{half.x, half.z, through};
      case ObstacleShape::capsule:
        return pbf::shape::Capsule<double>{half.x, half.z, through};
      case ObstacleShape::box:
        break;
    }
    return pbf::shape::Box<double>{half, through};
  }
};
inline pbf::Solid<double> solid_of(const SampleBody& body, pbf::Vec3<double> center = {}) {
  pbf::Solid<double> o;
  o.center = center;
  o.shape = body.kernels();
  return o;
}

struct ObstacleSample {
  std::string name;
  SampleBody body;
  pbf::Solid<double> obstacle;
  Level level;   ///< h, in the frame of the domain
  double reach;  ///< h, the solid (what is of interest of it) is within this distance of its centre
};

/// In body coordinates; `faces` counts the axes along which a box has faces.
inline double body_level(const SampleBody& o, const Point& p, int dimensions) {
  const Point half{o.half.x, o.half.y, o.half.z};
  const double ball = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - half[0];
  const double tube = std::sqrt(p[0] * p[0] + p[1] * p[1]) - half[0];
  const auto slab = [&](int k) {
    double s = -1e9;
    if (!(o.through >> (2 * k) & 1)) s = std::max(s, -half[k] - p[k]);
    if (!(o.through >> (2 * k) & 2)) s = std::max(s, p[k] - half[k]);
    return s;
  };
  switch (o.shape) {
    case ObstacleShape::plane:
      return p[2];
    case ObstacleShape::sphere:
      return ball;
    case ObstacleShape::cylinder:
      return dimensions == 2 ? tube : std::max(tube, slab(2));
    case ObstacleShape::box:
      return std::max({slab(0), dimensions == 2 ? -1e9 : slab(1), slab(2)});
    case ObstacleShape::capsule:
      break;
  }
  const double z = std::max(slab(2), 0.0);
  return std::sqrt(p[0] * p[0] + p[1] * p[1] + z * z) - half[0];
}

/// Turned by `angle` about `axis` (Rodrigues), with its centre somewhere.
inline ObstacleSample sample(const std::string& name, ObstacleShape shape, pbf::Vec3<double> half,
                             int dimensions = 3, Point axis = {0, 1, 0}, double angle = 0,
                             unsigned through = 0) {
  ObstacleSample s{
      name, {shape, half, through}, {}, {}, std::clamp(half.x + half.y + half.z, 1.0, 4.0)};
  s.obstacle.shape = s.body.kernels();
  s.obstacle.center = {1.3, dimensions == 2 ? 0 : -0.4, 2.1};
  const double length = std::hypot(axis[0], std::hypot(axis[1], axis[2]));
  const double c = std::cos(angle), w = std::sin(angle);
  for (double& a : axis) a /= length;
  const double across[3][3] = {
      {0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      s.obstacle.turn[i][j] = (i == j ? c : 0) + w * across[i][j] + (1 - c) * axis[i] * axis[j];
  s.level = [o = s.obstacle, body = s.body, dimensions](const Point& x) {
    const Point d{x[0] - o.center.x, dimensions == 2 ? 0 : x[1] - o.center.y, x[2] - o.center.z};
    Point p{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) p[i] += o.turn[i][j] * d[j];
    return body_level(body, p, dimensions);
  };
  return s;
}

inline std::vector<ObstacleSample> obstacle_samples(int dimensions) {
  const double quarter = std::acos(0.0);
  if (dimensions == 2)
    return {sample("plane", ObstacleShape::plane, {}, 2, {0, 1, 0}, 0.4),
            sample("box", ObstacleShape::box, {1, 0.1, 1.2}, 2, {0, 1, 0}, 0),
            sample("turned box", ObstacleShape::box, {1, 0.1, 1.2}, 2, {0, 1, 0}, 0.7),
            sample("plate", ObstacleShape::box, {0.05, 0.1, 1.2}, 2, {0, 1, 0}, 0.3),
            sample("disc", ObstacleShape::sphere, {1, 0, 0}, 2),
            sample("cylinder", ObstacleShape::cylinder, {1.5, 0, 0.1}, 2, {1, 0, 0}, quarter),
            sample("capsule", ObstacleShape::capsule, {1, 0, 1}, 2, {0, 1, 0}, 1.1)};
  return {
      sample("plane", ObstacleShape::plane, {}, 3, {1, 2, 3}, 0.8),
      sample("box", ObstacleShape::box, {1, 1.1, 1.2}),
      sample("turned box", ObstacleShape::box, {1, 1.1, 1.2}, 3, {1, 2, -1}, 0.9),
      sample("plate of 0.25 h", ObstacleShape::box, {1, 0.125, 1.2}),
      sample("plate of 0.1 h", ObstacleShape::box, {1, 0.05, 1.2}, 3, {1, 0, 1}, 0.5),
      sample("box through z_min", ObstacleShape::box, {1, 1.1, 1.2}, 3, {1, 0, 0}, 0, pbf::z_min),
      sample("small sphere", ObstacleShape::sphere, {0.3, 0, 0}),
      sample("sphere", ObstacleShape::sphere, {1.5, 0, 0}),
      sample("cylinder", ObstacleShape::cylinder, {1, 0, 1.4}, 3, {2, 1, 1}, 1.2),
      sample("wide cylinder", ObstacleShape::cylinder, {3, 0, 0.4}),
      sample("cylinder through z_max", ObstacleShape::cylinder, {1, 0, 1.4}, 3, {1, 0, 0}, 0,
             pbf::z_max),
      sample("capsule", ObstacleShape::capsule, {1, 0, 1}, 3, {1, -2, 1}, 0.6),
      sample("short capsule", ObstacleShape::capsule, {1, 0, 0.2}),
      sample("wide capsule", ObstacleShape::capsule, {3, 0, 1})};
}

template <class Real>
pbf::Vec3<Real> as(const Point& x) {
  return {Real(x[0]), Real(x[1]), Real(x[2])};
}
template <class Real>
pbf::Solid<Real> as(const pbf::Solid<double>& o) {
  pbf::Solid<Real> to;
  to.shape = o.shape.with(
      [](const auto& shape) { return pbf::SomeShape<Real>(shape.template scaled<Real>(1)); });
  to.center = {Real(o.center.x), Real(o.center.y), Real(o.center.z)};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) to.turn[i][j] = Real(o.turn[i][j]);
  return to;
}

inline constexpr double kRange = 0.7, kScale = 1.2065;  // of walls at h = 2 d

/// Places within `margin` of the surface on either side.
inline std::vector<Point> places_near(const ObstacleSample& s, int dimensions, int count,
                                      double margin = kRange) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Point> places;
  while (int(places.size()) < count) {
    const double r = s.reach + margin;
    const auto& c = s.obstacle.center;
    const Point x{c.x + r * u(random), dimensions == 2 ? 0 : c.y + r * u(random),
                  c.z + r * u(random)};
    if (std::fabs(pbf::distance(as<double>(s.obstacle), as<double>(x))) < margin ||
        (dimensions == 2 && std::fabs(s.level(x)) < margin))
      places.push_back(x);
  }
  return places;
}

template <pbf::Smoothing S>
double share(const ObstacleSample& s, const Point& x) {
  return pbf::solid_term<S>(s.obstacle, as<double>(x), 1 / kRange).share;
}

}  // namespace oracle_test
