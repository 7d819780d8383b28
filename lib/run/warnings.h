// Warnings about input or results that are valid but probably not intended.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/run/emit.h"

namespace pbf::run_module {

/// `kind`: units, step, speed, motion, table, obstacles, thin, wall, collision, overlap,
/// over-dense, seam, relaxation, output, wave_breaks and others of
/// wave_warnings() (of a scene); compressed, energy, stirred, passed_through,
/// closed_in, left, compare NAME (of a run). A list has at most one warning of each kind.
struct Warning {
  std::string kind, text;
};

/// Their texts, as lines of an error message.
std::string warning_lines(const std::vector<Warning>& warnings);

/// Mean compression above which a fluid is not a liquid (ratio).
constexpr double kNoLiquid = 0.05;

/// energy_rise from which the method is said to add energy (ratio).
constexpr double kAddsEnergy = 0.01;
/// energy_drift from which levels are said to stir a fluid that nothing moves (ratio).
constexpr double kStirred = 0.001;

/// Mean compression of the fluid at rest in its box, from time.step and the iterations: 2/3 (g
/// dt^2/h) (H/h) / iterations, with dt of a substep and the depth H of the fluid spread over the
/// floor. Within a factor of 2 for pools of 6 to 48 layers (lib/solver/DIAGNOSTICS.md, "Compression
/// at rest"). 0: no gravity, no floor, no iterations.
double compression_at_rest(const Scene& scene, std::int64_t particles);

/// Text about gravity above 200 or below 0.01 m/s^2, a rest density that no liquid has, a body
/// faster than 500 m/s, viscosity.xsph above 1, and a domain longer than 100 m in which gravity
/// moves nothing by a tenth of its length during the run; empty if there is none. All these values
/// are allowed.
std::string units_text(const Scene& scene);

/// Warnings of a scene, before it is run. `particles`: of count_particles(). Takes time
/// proportional to the number of particles that may overlap.
std::vector<Warning> scene_warnings(const StartPoints& points, std::int64_t particles);

}  // namespace pbf::run_module
