// Scenes with obstacles for tests, and whether particles are in them.
#pragma once

#include "tests/support/backend.h"

namespace obstacle_test {

using oracle_test::Case;

/// Lengths in h from the domain's lower corner; plates and planes end there too.
class Placing {
 public:
  explicit Placing(pbf::Scene& s) : s_(s) {}
  pbf::Double3 at(const pbf::Double3& x) const {
    pbf::Double3 to;
    for (std::size_t k = 0; k < 3; ++k) to[k] = s_.domain.min[k] + s_.h() * x[k];
    if (s_.plane()) to[1] = *s_.plane();
    return to;
  }
  pbf::Obstacle& box(const pbf::Double3& low, const pbf::Double3& high,
                     const pbf::Double3& axis = {0, 1, 0}, double degrees = 0) {
    pbf::Obstacle& o = add(pbf::ObstacleShape::box);
    o.min = at(low), o.max = at(high);
    o.turn_axis = axis, o.turn_angle = degrees;
    if (s_.plane()) o.min[1] = s_.domain.min[1], o.max[1] = s_.domain.max[1];
    return o;
  }
  pbf::Obstacle& sphere(const pbf::Double3& center, double radius) {
    pbf::Obstacle& o = add(pbf::ObstacleShape::sphere);
    o.center = at(center), o.radius = radius * s_.h();
    return o;
  }
  /// A cylinder or a capsule.
  pbf::Obstacle& tube(pbf::ObstacleShape shape, const pbf::Double3& from, const pbf::Double3& to,
                      double radius) {
    pbf::Obstacle& o = add(shape);
    o.from = at(from), o.to = at(to), o.radius = radius * s_.h();
    return o;
  }
  pbf::Obstacle& plane(const pbf::Double3& point, const pbf::Double3& normal) {
    pbf::Obstacle& o = add(pbf::ObstacleShape::plane);
    o.point = at(point), o.normal = normal;
    return o;
  }

 private:
  pbf::Obstacle& add(pbf::ObstacleShape shape) {
    pbf::Obstacle& o = s_.obstacles.emplace_back();
    o.name = "o" + std::to_string(s_.obstacles.size());
    o.shape = shape;
    o.loads = true;
    return o;
  }
  pbf::Scene& s_;
};

/// h, how deep in obstacles a place is, by the oracle's own shapes; below 0 outside.
inline double depth_in(const std::vector<oracle::Solid>& solids, const pbf::Scene& s,
                       const double* x) {
  long double deepest = -1e9L;
  for (const oracle::Solid& o : solids)
    deepest = std::max(deepest, -oracle::level(o, {x[0], x[1], x[2]}, s.dimensions));
  return double(deepest / s.h());
}
/// Of all particles the deepest.
inline double deepest(const Case& c, const pbf::Snapshot& snap) {
  const auto solids = oracle_test::oracle_solids(c.scene);
  const auto x = snap.fields[0].as<double>();
  double most = -1e9;
  for (std::size_t i = 0; i < snap.count; ++i)
    most = std::max(most, depth_in(solids, c.scene, &x[3 * i]));
  return most;
}

/// Without the particles that start nearer to an obstacle than so many h.
inline Case without_inner(Case c, double least = 0) {
  const auto solids = oracle_test::oracle_solids(c.scene);
  pbf::Particles left;
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const auto& x = c.particles.position[i];
    if (depth_in(solids, c.scene, x.data()) > -least) continue;
    left.position.push_back(x);
    left.velocity.push_back(c.particles.velocity[i]);
  }
  c.particles = left;
  return c;
}

inline pbf::Snapshot places_of(pbf::Solver& s) {
  return s.download({}, pbf::ScalarType::f64).get();
}

/// h, how far behind a face rounding may leave what is held there: coordinates are below 50 h.
inline double fine() { return backend_test::is_double() ? 1e-13 : 3e-5; }

}  // namespace obstacle_test
