#include "lib/solver/diagnostics.h"

#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "lib/scene/vector3.h"
#include "lib/solver/params.h"

namespace pbf::solver_module {
namespace {

using M = const Diagnostics&;
using enum Over;

RestPool rest_pool(const Scene& scene, const Plan& plan, std::int64_t particles) {
  const Scene s = in_internal_axes(scene, plan.axes);
  const unsigned walls = make_params<double>(scene, plan).boundary.walls;
  const double h = s.h();
  double extent[3], area = 1;
  int axis = -1, along = 0;
  for (int k = 0; k < 3; ++k) {
    const auto i = std::size_t(k);
    extent[k] = (s.domain.max[i] - s.domain.min[i]) / h;
    if (s.gravity[i] != 0) axis = k, ++along;
  }
  RestPool pool;
  if (along != 1 || !scene.obstacles.empty() || scene.tank_motion || comes_and_goes(scene))
    return pool;
  const bool points_up = s.gravity[std::size_t(axis)] > 0;
  for (int k = 0; k < 3; ++k) {
    const bool wall = k != 1 || s.dimensions == 3;  // a slab needs no walls at its two faces
    const unsigned low = 1u << (2 * k), needed = k == axis ? (points_up ? 2 * low : low) : 3 * low;
    if (wall && (walls & needed) != needed) return pool;
    if (k != axis) area *= extent[k];
  }
  pool.axis = axis;
  pool.up = points_up ? -1 : 1;
  pool.floor = points_up ? extent[axis] : 0;
  pool.depth = plan.mass * double(particles) / (s.fluid.rest_density * h * h * h) / area;
  pool.spacing = s.fluid.spacing / h;
  return pool;
}

/// Height kept and distance to the hydrostatic profile (formulas: lib/solver/DIAGNOSTICS.md).
void measure_pool(const MeasureSums& s, const RestPool& pool, double counted, Diagnostics& m) {
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

MeasureConstants measure_constants(const Scene& scene, const Plan& plan, std::int64_t particles) {
  return {rest_pool(scene, plan, particles)};
}

Diagnostics to_diagnostics(const MeasureSums& s, std::int64_t particles,
                           const MeasureConstants& given, double lag, const Scene& scene,
                           const Plan& plan, std::int64_t update, std::int64_t steps) {
  const double h = scene.h(), n = double(particles > 0 ? particles : 1), mass = plan.mass;
  const Double3 origin = scene.origin();
  const double counted = double(particles - s.non_finite);
  // Where particles come and go the zero of the energy stays that of the start.
  const double of_start = comes_and_goes(scene) ? double(plan.particles) : counted;
  Diagnostics m;
  m.time = double(update) * scene.time.step;
  m.update = update;
  m.particles = particles;
  m.velocity_lag = lag;
  m.compression_mean = s.compression / n;
  m.compression_rms = std::sqrt(s.compression_squared / n);
  m.compression_p99 = s.compression_p99;
  m.compression_max = s.compression_max;
  m.share_above_1 = double(s.above_1) / n;
  m.share_above_10 = double(s.above_10) / n;
  // If a solid fills the box, its surface may be arbitrarily far away: at most the diagonal.
  const Double3 box = scene.domain.max - scene.domain.min;
  m.penetration = std::min(h * s.penetration, std::hypot(box[0], box[1], box[2]));
  m.kinetic_energy = 0.5 * mass * h * h * s.speed_squared;
  for (int k = 0; k < 3; ++k) {
    const auto axis = std::size_t(plan.axes.of[k]);
    m.momentum[axis] = mass * h * s.v[k];
    // Along a periodic axis gravity has no potential: its work is that of a drive.
    if (scene.domain.is_periodic(int(axis))) {
      m.power += scene.gravity[axis] * m.momentum[axis];
    } else {
      m.potential_energy -= mass * scene.gravity[axis] * h * (s.x[k] - lag * s.v[k]);
      // The reference of the energy is the lowest corner of the box, into which gravity points.
      const double extent = scene.domain.max[axis] - scene.domain.min[axis];
      m.energy += mass * std::max(scene.gravity[axis], 0.0) * extent * of_start;
    }
    m.center_of_mass[axis] = origin[axis] + h * s.x[k] / (counted > 0 ? counted : 1);
    m.front[axis] = origin[axis] + h * s.front[k];
  }
  m.energy += m.kinetic_energy + m.potential_energy;
  measure_pool(s, given.rest, counted, m);
  m.speed_max = h * std::sqrt(s.speed_squared_max);
  m.neighbors_mean = double(s.neighbors) / n;
  m.neighbors_max = s.neighbors_max;
  m.outside = s.outside;
  m.non_finite = s.non_finite;
  m.fast = s.fast;
  m.unresolved = s.unresolved;
  m.relative_way_max = std::sqrt(s.way_squared);
  m.iterations_done = scene.solver.iterations * (plan.substeps * steps + s.repeats);
  return m;
}

std::span<const Diagnostic> diagnostics() {
  static const auto table = std::to_array<Diagnostic>({
      {"compression_mean", "1", "sum of c/N", mean, true, [](M m) { return m.compression_mean; }},
      {"compression_rms", "1", "sqrt(sum of c^2/N)", rms, false,
       [](M m) { return m.compression_rms; }},
      {"compression_p99", "1", "c that 99 % of the particles are at or below", mean, true,
       [](M m) { return m.compression_p99; }},
      {"compression_max", "1", "largest c", max, true, [](M m) { return m.compression_max; }},
      {"share_above_1", "1", "particles with c > 1 %", mean, false,
       [](M m) { return m.share_above_1; }},
      {"share_above_10", "1", "particles with c > 10 %", mean, false,
       [](M m) { return m.share_above_10; }},
      {"height_kept", "1", "2 x height of the centre of mass above the floor / H0", mean, true,
       [](M m) { return m.height_kept; }},
      {"hydrostatic_deviation", "1", "RMS of (weight above z - rho0 g (H0 - z)) / (rho0 g H0)",
       mean, false, [](M m) { return m.hydrostatic_deviation; }},
      {"kinetic_energy", "J", "sum of m v^2/2", none, true, [](M m) { return m.kinetic_energy; }},
      {"potential_energy", "J", "-sum of m g.x, x from the domain's lower corner", none, false,
       [](M m) { return m.potential_energy; }},
      {"energy", "J", "E: kinetic and potential above the box's lowest corner", none, true,
       [](M m) { return m.energy; }},
      {"energy_drift", "1",
       "(E - W - E0)/E0; W: work of moving bodies, E0: E at the start (if none: the largest E)",
       last, true, [](M m) { return m.energy_drift; }},
      {"energy_rise", "1", "largest (E - W) - (lowest E - W before), over E0", last, true,
       [](M m) { return m.energy_rise; }},
      {"momentum_x", "kg m/s", "sum of m v", none, false, [](M m) { return m.momentum[0]; }},
      {"momentum_y", "kg m/s", "", none, false, [](M m) { return m.momentum[1]; }},
      {"momentum_z", "kg m/s", "", none, false, [](M m) { return m.momentum[2]; }},
      {"center_of_mass_x", "m", "sum of x/N", none, false, [](M m) { return m.center_of_mass[0]; }},
      {"center_of_mass_y", "m", "", none, false, [](M m) { return m.center_of_mass[1]; }},
      {"center_of_mass_z", "m", "", none, false, [](M m) { return m.center_of_mass[2]; }},
      {"speed_max", "m/s", "largest |v|", max, true, [](M m) { return m.speed_max; }},
      {"front_x", "m", "largest coordinate", none, true, [](M m) { return m.front[0]; }},
      {"front_y", "m", "", none, false, [](M m) { return m.front[1]; }},
      {"front_z", "m", "", none, false, [](M m) { return m.front[2]; }},
      {"penetration", "m", "farthest that a particle is behind its clamp at a wall", max, false,
       [](M m) { return m.penetration; }},
      {"neighbors_mean", "1", "particles closer than h, without the particle itself", mean, false,
       [](M m) { return m.neighbors_mean; }},
      {"neighbors_max", "1", "most of them", none, false, nullptr,
       [](M m) { return m.neighbors_max; }},
      {"outside", "1", "particles beyond a wall", none, false, nullptr,
       [](M m) { return m.outside; }},
      {"non_finite", "1", "particles with a NaN or infinity, in no other measure", none, false,
       nullptr, [](M m) { return m.non_finite; }},
      {"fast", "1", "particles x updates above solver.speed_limit or guard.speed so far", none,
       false, nullptr, [](M m) { return m.fast; }},
      {"iterations_done", "1", "over the constraints so far", none, false, nullptr,
       [](M m) { return m.iterations_done; }},
      {"unresolved", "1", "particles x steps that moved by more than 0.4 h past a neighbor so far",
       none, false, nullptr, [](M m) { return m.unresolved; }},
      {"relative_way_max", "h", "longest such way in a step", none, false,
       [](M m) { return m.relative_way_max; }},
  });
  static_assert(std::tuple_size_v<std::remove_cv_t<decltype(table)>> == kDiagnosticColumns);
  return table;
}

std::string diagnostics_help() {
  std::string text =
      "Diagnostics (formulas: lib/solver/DIAGNOSTICS.md; c = max(rho/rho0 - 1, 0) of a particle, "
      "walls\nincluded; H0 = volume of the fluid / area of the floor):\n";
  for (const Diagnostic& d : diagnostics()) {
    if (*d.help == '\0') continue;  // second and third component of a vector
    std::string name = d.name;
    if (name.ends_with("_x")) name += ", _y, _z";
    text += fmt::format("  {:24} {} [{}]\n", name, d.help, d.unit);
  }
  return text;
}

}  // namespace pbf::solver_module
