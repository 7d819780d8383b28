// States for tests: made from integers, so the same everywhere.
#pragma once

#include <cstdint>
#include <random>

#include "lib/exec/make_solver.h"
#include "lib/program/calibrate.h"
#include "lib/program/plan.h"
#include "lib/solver/solver.h"

namespace oracle_test {

/// From -1 to 1; the integers of the generator are fixed by the standard.
inline double random_number(std::mt19937& gen) { return double(gen()) / 4294967295.0 * 2 - 1; }

/// A box of `extent` cells of the spacing, a lattice block in its lower corner (so it touches
/// walls, edges and corners), every particle displaced by up to `jitter` spacings, random
/// velocities.
struct Case {
  pbf::Scene scene;
  pbf::Particles particles;
};

inline Case jittered_block(int nx, int ny, int nz, double jitter, double speed,
                           std::uint32_t seed = 1, double squeeze = 1.0) {
  Case c;
  const double d = 0.02;
  c.scene.fluid.spacing = d;
  c.scene.domain.min = {-0.1, 0.3, -2};
  c.scene.domain.max = {-0.1 + d * (nx + 2), 0.3 + d * ny, -2 + d * (nz + 3)};
  c.scene.time = {0.002, 1, {}};
  c.scene.precision = pbf::Precision::dbl;
  c.scene.threads = 1;
  std::mt19937 gen(seed);
  const auto random = [&] { return random_number(gen); };
  const auto &lo = c.scene.domain.min, &hi = c.scene.domain.max;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        pbf::Double3 p{lo[0] + (x + 0.5 + jitter * random()) * d * squeeze,
                       lo[1] + (y + 0.5 + jitter * random()) * d * squeeze,
                       lo[2] + (z + 0.5 + jitter * random()) * d * squeeze};
        for (std::size_t k = 0; k < 3; ++k) p[k] = std::min(std::max(p[k], lo[k]), hi[k]);
        c.particles.position.push_back(p);
        c.particles.velocity.push_back({speed * random(), speed * random(), speed * random()});
      }
  return c;
}

/// The same in two dimensions: a square lattice in a slab one spacing thick.
inline Case flat_block(int nx, int nz, double jitter, double speed, std::uint32_t seed = 1,
                       double squeeze = 1.0) {
  Case c = jittered_block(nx, 1, nz, jitter, speed, seed, squeeze);
  c.scene.dimensions = 2;
  for (auto& x : c.particles.position) x[1] = *c.scene.plane();
  for (auto& v : c.particles.velocity) v[1] = 0;
  return c;
}

inline std::unique_ptr<pbf::Solver> make(const Case& c) {
  pbf::StartNeighbors start;
  start.of_files = {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}};  // no depth limits the levels
  const pbf::Plan plan = pbf::make_plan(c.scene, std::int64_t(c.particles.size()), start);
  return pbf::make_solver(c.scene, plan, c.particles);
}

}  // namespace oracle_test
