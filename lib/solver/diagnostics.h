// The diagnostics of a run (scalars over all particles) and their table. The log of the run file,
// the lines of --log-json, the measures of a study, the summary of a batch and the help are printed
// from the table. Formulas: DIAGNOSTICS.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/measure.h"
#include "lib/program/plan.h"

namespace pbf::solver_module {

/// SI units. Compression of a particle: c = max(rho/rho0 - 1, 0); rho includes the walls'
/// contribution. NaN: not defined in this scene.
struct Diagnostics {
  double time = 0;  ///< s
  std::int64_t update = 0;
  double compression_mean = 0;           ///< 1
  double compression_rms = 0;            ///< 1
  double compression_p99 = 0;            ///< 1, 99 % of the particles are at or below it
  double compression_max = 0;            ///< 1
  double share_above_1 = 0;              ///< 1, particles compressed by more than 1 %
  double share_above_10 = 0;             ///< 1, by more than 10 %
  double height_kept = 0;                ///< 1, twice the height of the center over the rest depth
  double hydrostatic_deviation = 0;      ///< 1, RMS error of the weight above eight levels
  double kinetic_energy = 0;             ///< J
  double potential_energy = 0;           ///< J, -m g.x relative to the domain's lower corner
  double energy = 0;                     ///< J, kinetic and potential above the box's lowest corner
  double energy_drift = 0;               ///< 1, (E - W - E0)/E0, W the work; EnergyTrack
  double energy_rise = 0;                ///< 1, largest rise of E - W above an earlier value, / E0
  double momentum[3] = {0, 0, 0};        ///< kg m/s
  double center_of_mass[3] = {0, 0, 0};  ///< m
  double speed_max = 0;                  ///< m/s
  double front[3] = {0, 0, 0};           ///< m, largest coordinate along each axis
  double penetration = 0;                ///< m, largest distance of a particle behind its clamp
  double neighbors_mean = 0;             ///< without the particle itself
  std::int64_t neighbors_max = 0;
  std::int64_t outside = 0;     ///< particles beyond a wall
  std::int64_t non_finite = 0;  ///< particles with a non-finite position or velocity
  /// Number of times since the start that a particle was above solver.speed_limit in an update and
  /// was slowed down; without this key, above guard.speed.
  std::int64_t fast = 0;
  std::int64_t iterations_done = 0;  ///< solver iterations since the start
  /// Number of times since the start that a particle moved by more than kResolvedWay relative to a
  /// neighbor in a step (kernels/relative_motion.h), so that fluid may pass through fluid.
  std::int64_t unresolved = 0;
  double relative_way_max = 0;  ///< h, the longest such displacement in a step; 0: none
  double velocity_lag = 0;      ///< s, by how much momenta are earlier than `time`
  bool moved = false;           ///< obstacles, the tank or gravity along a periodic axis do work
  double power = 0;             ///< W, of the tank's motion, and of gravity along periodic axes
  double solid_work =
      0;  ///< J, of moving obstacles in the current interval of loads; lost by free bodies
  double inflow = 0;           ///< J, by emitters less what sinks took, since the start
  std::int64_t particles = 0;  ///< their present number
  double work = 0;             ///< J, of obstacles, tank and inflow since the start; WorkTrack
  /// Of Series::measures (lib/program/column.h), since the previous row. Monitor fills them in.
  std::vector<double> readings{};
  std::vector<BodyMotion> bodies{};  ///< of the free bodies, in the order of obstacles
};

/// The state of an EnergyTrack and a WorkTrack, as a checkpoint stores it. J; rise: 1.
struct EnergyHistory {
  bool started = false;
  double first = 0, lowest = 0, largest = 0, rise = 0;
  double work = 0, power = 0, time = 0;  ///< of the last energies: WorkTrack; s
};

/// Follows the work of prescribed motions. Updates book the work of obstacles; the power of the
/// tank's motion is measured and assumed linear between two measurements.
class WorkTrack {
 public:
  explicit WorkTrack(const EnergyHistory& before = {})
      : work_(before.work), power_(before.power), time_(before.time) {}
  /// J, the work up to measurement m.
  double until(const Diagnostics& m) const { return m.inflow + motion_until(m); }
  /// To be called with each measurement at which the interval of the loads ends.
  void take(const Diagnostics& m) {
    work_ = motion_until(m);
    power_ = m.power;
    time_ = m.time - m.velocity_lag;
  }

 private:
  double motion_until(const Diagnostics& m) const {
    return work_ + m.solid_work + 0.5 * (power_ + m.power) * (m.time - m.velocity_lag - time_);
  }
  double work_, power_, time_;
};

/// Follows E - W from the first measurement on: the energy without the work of prescribed motions,
/// so only the numerical method can make it rise. If the start has no energy (E0 at most 1e-12 of
/// the largest E so far), drift and rise are relative to the largest E so far. A rise of 1 then
/// means that the method created all of it. Where energy comes in with particles, drift and rise
/// are relative to the largest E so far, too, if that is more. The results are always finite.
class EnergyTrack {
 public:
  explicit EnergyTrack(const EnergyHistory& before = {}) : h_(before) {
    h_.largest = std::max({h_.largest, h_.first, h_.lowest});
    if (!std::isfinite(h_.rise)) h_.rise = 1;  // older checkpoints may contain infinity
  }
  /// Fills m.energy_drift and m.energy_rise. To be called with every measurement, in order.
  void follow(Diagnostics& m) {
    const double own = m.energy - m.work;
    flows_ = flows_ || m.inflow != 0;
    if (!h_.started) h_.first = h_.lowest = h_.largest = own;
    h_.started = true;
    h_.largest = std::max(h_.largest, m.energy);
    h_.rise = std::max(h_.rise, relative(own - h_.lowest));
    h_.lowest = std::min(h_.lowest, own);
    m.energy_drift = relative(own - h_.first);
    m.energy_rise = h_.rise;
    h_.work = m.work - m.inflow;
    h_.power = m.power;
    h_.time = m.time - m.velocity_lag;
  }
  const EnergyHistory& history() const { return h_; }

 private:
  double relative(double e) const {
    const bool of_start = h_.first > (flows_ ? 1 : 1e-12) * h_.largest;
    return e == 0 ? 0 : e / (of_start ? h_.first : h_.largest);
  }
  bool flows_ = false;
  EnergyHistory h_;
};

/// particles: their present number.
MeasureConstants measure_constants(const Scene& scene, const Plan& plan, std::int64_t particles);

/// Converts sums over the particles in the internal frame to diagnostics in SI units along the
/// scene's axes (DIAGNOSTICS.md). lag: s, by how much the velocities are earlier than the
/// positions. update, steps: done so far.
Diagnostics to_diagnostics(const MeasureSums& sums, std::int64_t particles,
                           const MeasureConstants& given, double lag, const Scene& scene,
                           const Plan& plan, std::int64_t update, std::int64_t steps);

/// How a study combines the measurements of its window into one value.
enum class Over { none, mean, rms, max, last };

struct Diagnostic {
  const char* name;  ///< of the column; the components of a vector end in _x, _y, _z
  const char* unit;  ///< "1": dimensionless
  const char* help;  ///< a phrase; empty for the further components of a vector
  Over over;         ///< none: not in a study's table
  bool summary;      ///< a column of a batch's summary.csv
  double (*number)(const Diagnostics&);  ///< null for an integer
  std::int64_t (*integer)(const Diagnostics&) = nullptr;

  double value(const Diagnostics& m) const { return number ? number(m) : double(integer(m)); }
};

/// In the order of the log's columns.
std::span<const Diagnostic> diagnostics();

/// For help texts: a line for each, with its unit.
std::string diagnostics_help();

}  // namespace pbf::solver_module
