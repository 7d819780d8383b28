#include "lib/solver/step_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lib/base/error.h"

namespace pbf::inline solver_module {

namespace {

/// Volume kept and distance to the hydrostatic profile; lib/solver/DIAGNOSTICS.md has the formulas.
void measure_pool(const MeasureSums& s, const RestPool& pool, double counted, Measures& m) {
  m.height_kept = m.hydrostatic_deviation = std::numeric_limits<double>::quiet_NaN();
  if (pool.axis < 0 || counted == 0) return;
  const double center = s.x[pool.axis] / counted;
  m.height_kept = 2 * pool.up * (center - pool.floor) / pool.depth;
  double squares = 0;
  for (int k = 0; k < MeasureSums::levels; ++k) {
    const double e = double(k + 1) / MeasureSums::levels - s.below[k] / counted;
    squares += e * e;
  }
  m.hydrostatic_deviation = std::sqrt(squares / MeasureSums::levels);
}

}  // namespace

Measures to_measures(const MeasureSums& s, const Scene& scene, const Plan& plan,
                     std::int64_t update, std::int64_t steps) {
  const double h = scene.h(), n = double(plan.particles), mass = plan.mass;
  const Double3 origin = scene.origin();
  const double counted = double(plan.particles - s.non_finite);
  Measures m;
  m.time = double(update) * scene.time.step;
  m.update = update;
  m.compression_mean = s.compression / n;
  m.compression_rms = std::sqrt(s.compression_squared / n);
  m.compression_p99 = s.compression_p99;
  m.compression_max = s.compression_max;
  m.share_above_1 = double(s.above_1) / n;
  m.share_above_10 = double(s.above_10) / n;
  m.penetration = h * s.penetration;
  m.kinetic_energy = 0.5 * mass * h * h * s.speed_squared;
  for (int k = 0; k < 3; ++k) {
    const auto axis = std::size_t(plan.axes.of[k]);
    m.potential_energy -= mass * scene.gravity[axis] * h * s.x[k];
    // The lowest corner of the box: where gravity would carry a particle.
    const double extent = scene.domain.max[axis] - scene.domain.min[axis];
    m.energy += mass * std::max(scene.gravity[axis], 0.0) * extent * counted;
    m.momentum[axis] = mass * h * s.v[k];
    m.center_of_mass[axis] = origin[axis] + h * s.x[k] / (counted > 0 ? counted : 1);
    m.front[axis] = origin[axis] + h * s.front[k];
  }
  m.energy += m.kinetic_energy + m.potential_energy;
  const Params<double> p = make_params<double>(scene, plan);
  measure_pool(s, p.rest, counted, m);
  m.speed_max = h * std::sqrt(s.speed_squared_max);
  m.neighbors_mean = double(s.neighbors) / n;
  m.neighbors_max = s.neighbors_max;
  m.outside = s.outside;
  m.non_finite = s.non_finite;
  m.fast = s.fast;
  m.unresolved = s.unresolved;
  m.relative_way_max = std::sqrt(s.way_squared);
  m.sweeps = scene.solver.iterations * (plan.substeps * steps + s.rounds);
  return m;
}

void check_state(const SolverState& s, std::int64_t n) {
  const std::size_t count = std::size_t(n);
  std::vector<bool> seen(count, false);
  bool good =
      s.id.size() == count && s.position.size() == 3 * count && s.velocity.size() == 3 * count;
  for (std::size_t k = 0; good && k < count; ++k) {
    const auto id = std::size_t(s.id[k]);
    good = s.id[k] >= 0 && id < count && !seen[id];
    if (good) seen[id] = true;
  }
  if (!good)
    throw Error(ExitCode::internal, "a state of " + std::to_string(s.id.size()) +
                                        " particles does not fit a solver of " + std::to_string(n) +
                                        ", or its ids are not 0..n-1");
}

Snapshot empty_snapshot(const std::vector<std::string>& fields, ScalarType type, std::size_t n,
                        std::int64_t update, double time) {
  bool velocity = false, density = false;
  for (const std::string& f : fields) {
    if (f == "velocity")
      velocity = true;
    else if (f == "density")
      density = true;
    else if (f != "position" && f != "id")
      throw Error(ExitCode::bad_input, "no field \"" + f + "\"; there are velocity and density");
  }
  Snapshot s;
  s.update = update;
  s.time = time;
  s.count = n;
  auto add = [&](const char* name, const char* unit, ScalarType t, int components) {
    s.fields.push_back({name, unit, t, components, {}});
    s.fields.back().bytes.resize(n * std::size_t(components) * size_of(t));
  };
  add("position", "m", type, 3);
  if (velocity) add("velocity", "m/s", type, 3);
  if (density) add("density", "kg/m^3", type, 1);
  add("id", "1", ScalarType::i32, 1);
  auto id = s.fields.back().as<std::int32_t>();
  for (std::size_t i = 0; i < n; ++i) id[i] = std::int32_t(i);
  return s;
}

}  // namespace pbf::inline solver_module
