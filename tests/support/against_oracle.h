// A solver's update held to the brute-force oracle.
#pragma once

#include <algorithm>
#include <cmath>

#include "lib/program/time_order.h"
#include "tests/oracle/n2_levels.h"
#include "tests/support/states.h"

namespace oracle_test {

/// The obstacles, of which faces on walls or behind them are none: boxes that are not turned alone
/// have such faces here.
inline std::vector<oracle::Solid> oracle_solids(const pbf::Scene& s) {
  using Shape = oracle::Solid::Shape;
  std::vector<oracle::Solid> all;
  for (const pbf::Obstacle& o : s.obstacles) {
    oracle::Solid& to = all.emplace_back();
    to.shape = Shape(int(o.shape.index()));
    namespace keys = pbf::obstacle_keys;
    const auto keys_of = [&]<class Keys>(const Keys&) {
      return std::holds_alternative<Keys>(o.shape) ? o.as<Keys>() : Keys{};
    };
    const keys::Box box = keys_of(keys::Box{});
    const keys::Plane plane = keys_of(keys::Plane{});
    const keys::Sphere sphere = keys_of(keys::Sphere{});
    const keys::Tube tube = to.shape == Shape::capsule ? keys::Tube(keys_of(keys::Capsule{}))
                                                       : keys_of(keys::Cylinder{});
    oracle::V axis{box.turn_axis[0], box.turn_axis[1], box.turn_axis[2]};
    long double angle = acosl(-1) / 180 * box.turn_angle;
    for (std::size_t k = 0; k < 3; ++k) {
      long double low = box.min[k], high = box.max[k];
      if (to.shape == Shape::box && box.turn_angle == 0) {
        if (low <= s.domain.min[k] && !s.domain.is_open(int(k), false)) low -= 1e3;
        if (high >= s.domain.max[k] && !s.domain.is_open(int(k), true)) high += 1e3;
      }
      if (to.shape == Shape::sphere) low = high = sphere.center[k];
      if (to.shape == Shape::plane) low = high = plane.point[k];
      if (to.shape >= Shape::cylinder) low = high = (tube.from[k] + tube.to[k]) / 2;
      to.center[k] = (low + high) / 2;
      to.half[k] = (high - low) / 2;
    }
    if (to.shape >= Shape::sphere)
      to.half[0] = to.shape == Shape::sphere ? sphere.radius : tube.radius;
    if (to.shape == Shape::plane || to.shape >= Shape::cylinder) {
      // From z to the direction wanted, about what is at right angles to both.
      oracle::V z;
      for (std::size_t k = 0; k < 3; ++k)
        z[k] = to.shape == Shape::plane ? plane.normal[k] : tube.to[k] - tube.from[k];
      to.half[2] = hypotl(hypotl(z[0], z[1]), z[2]) / 2;
      axis = {-z[1], z[0], 0};
      angle = atan2l(hypotl(z[0], z[1]), z[2]);
    }
    const long double size = hypotl(hypotl(axis[0], axis[1]), axis[2]);
    for (std::size_t k = 0; size > 0 && k < 3; ++k) {
      oracle::V &e = to.axes[k], u = axis;
      for (auto& a : u) a /= size;
      const long double along = u[k], c = cosl(angle), w = sinl(angle);
      const oracle::V side{u[1] * e[2] - u[2] * e[1], u[2] * e[0] - u[0] * e[2],
                           u[0] * e[1] - u[1] * e[0]};
      for (std::size_t i = 0; i < 3; ++i) e[i] = c * e[i] + w * side[i] + (1 - c) * along * u[i];
    }
  }
  return all;
}

inline oracle::Settings settings_of(const Case& c) {
  const pbf::Scene& s = c.scene;
  oracle::Settings o;
  o.h = s.h();
  o.rest_density = s.fluid.rest_density;
  o.dimensions = s.dimensions;
  if (s.fluid.mass) {
    o.mass = *s.fluid.mass;
    if (s.dimensions == 2) o.mass /= s.domain.max[1] - s.domain.min[1];
    o.wall_scale = 1;
  } else {
    const auto cal = pbf::calibrate(s.solver.kernels, s.fluid.smoothing_ratio, s.dimensions);
    o.mass = static_cast<long double>(cal.vol) * o.rest_density * powl(o.h, s.dimensions);
    o.wall_scale = cal.wall_scale;
    o.wall_range = cal.wall_range;
  }
  o.dt = s.time.step;
  o.cfm = s.solver.cfm;
  o.sor = pbf::make_plan(s, std::int64_t(c.particles.size())).sor;
  o.under_relax = !s.solver.sor;
  o.substeps = s.solver.substeps;
  o.levels = s.solver.levels == pbf::LevelsMode::on;
  o.spacing = s.fluid.spacing;
  o.solids = oracle_solids(s);
  const char* faces[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  for (std::size_t f = 0; f < 6; ++f)
    o.open[f] = std::count(s.domain.open.begin(), s.domain.open.end(), faces[f]) > 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (const std::string& axis : s.domain.periodic)
      if (axis[0] == char('x' + k)) {
        o.period[k] = s.domain.max[k] - s.domain.min[k];
        o.open[2 * k] = o.open[2 * k + 1] = true;
      }
  o.damping = s.solver.velocity_damping;
  o.paper = s.solver.kernels == pbf::KernelMode::paper;
  o.margin = s.solver.wall_margin;
  o.iterations = s.solver.iterations;
  o.order = pbf::is_second_order(s) ? 2 : 1;
  o.two_sided = s.solver.constraint == pbf::ConstraintMode::two_sided;
  o.wall_density = s.solver.boundary == pbf::BoundaryMode::density;
  for (int k = 0; k < 3; ++k) {
    o.gravity[k] = s.gravity[k];
    o.low[k] = s.domain.min[k];
    o.high[k] = s.domain.max[k];
  }
  if (s.tensile) {
    o.tensile_k = s.tensile->k;
    o.tensile_q = s.tensile->delta_q;
    o.tensile_n = s.tensile->n;
  }
  if (s.viscosity) o.xsph = s.viscosity->xsph;
  if (s.vorticity) o.vorticity = s.vorticity->epsilon;
  return o;
}

struct Difference {
  double position = 0;  // in units of h
  double velocity = 0;  // in units of h/dt
  oracle::LevelNodes nodes;
};

/// Largest difference after some updates from the same state.
inline Difference against_oracle(const Case& c, int updates = 1) {
  const oracle::Settings o = settings_of(c);
  oracle::State s;
  for (std::size_t i = 0; i < c.particles.size(); ++i) {
    const auto &x = c.particles.position[i], &v = c.particles.velocity[i];
    s.x.push_back({x[0], x[1], x[2]});
    s.v.push_back({v[0], v[1], v[2]});
  }
  Difference d;
  for (int u = 0; u < updates; ++u) oracle::update(s, o, &d.nodes);
  auto solver = make(c);
  solver->step(updates);
  const pbf::Snapshot snap = solver->download({"velocity"}, pbf::ScalarType::f64).get();
  const auto x = snap.fields[0].as<double>(), v = snap.find("velocity")->as<double>();
  for (std::size_t i = 0; i < s.x.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      long double way = x[3 * i + k] - s.x[i][k];
      if (o.period[k] > 0) way = remainderl(way, o.period[k]);
      d.position = std::max(d.position, double(fabsl(way) / o.h));
      d.velocity = std::max(d.velocity, double(fabsl(v[3 * i + k] - s.v[i][k]) * o.dt / o.h));
    }
  return d;
}

}  // namespace oracle_test
