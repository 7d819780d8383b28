// Scenes with obstacles for tests, and whether particles are in them.
#pragma once

#include "tests/support/backend.h"
#include "tests/support/obstacle_shapes.h"

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
    pbf::Double3 min = at(low), max = at(high);
    if (s_.plane()) min[1] = s_.domain.min[1], max[1] = s_.domain.max[1];
    return add(pbf_test::box_obstacle(min, max, axis, degrees));
  }
  pbf::Obstacle& sphere(const pbf::Double3& center, double radius) {
    return add(pbf_test::sphere_obstacle(at(center), radius * s_.h()));
  }
  /// A cylinder or a capsule.
  pbf::Obstacle& tube(pbf_test::ObstacleShape shape, const pbf::Double3& from,
                      const pbf::Double3& to, double radius) {
    return add(pbf_test::tube_obstacle(shape, at(from), at(to), radius * s_.h()));
  }
  pbf::Obstacle& plane(const pbf::Double3& point, const pbf::Double3& normal) {
    return add(pbf_test::plane_obstacle(at(point), normal));
  }

 private:
  pbf::Obstacle& add(pbf::Obstacle made) {
    pbf::Obstacle& o = s_.obstacles.emplace_back(std::move(made));
    o.name = "o" + std::to_string(s_.obstacles.size());
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

/// A solver after 300 updates at this level: 100 in batches on one thread, 100 after a resume, 30
/// that are taken back, and 100.
inline std::unique_ptr<pbf::Solver> by_detours(const Case& c, int level) {
  Case other = c;
  other.scene.threads = 1;
  auto many = make(other);
  for (const int n : {1, 7, 90, 2}) {
    many->step(n, {.level = level});
    many->diagnose();
  }
  auto fresh = make(c);
  fresh->set_state(many->state());
  CHECK(fresh->diagnose().bodies == many->diagnose().bodies);
  fresh->step(100, {.level = level});
  fresh->keep();
  fresh->step(30, {.level = level});
  fresh->set_state(fresh->state(pbf::StateOf::kept));  // back
  fresh->step(100, {.level = level});
  return fresh;
}

/// h, how far behind a face rounding may leave what is held there: coordinates are below 50 h.
inline double fine() { return backend_test::is_double() ? 1e-13 : 3e-5; }

}  // namespace obstacle_test
