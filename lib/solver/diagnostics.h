// The diagnostics of a run (scalars over all particles) and their table. The log of the run file,
// the lines of --log-json, the measures of a study, the summary of a batch and the help are printed
// from the table. Formulas: DIAGNOSTICS.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/measure.h"
#include "lib/program/plan.h"
#include "lib/solver/wall_loads.h"

namespace pbf::inline solver_module {

/// SI units. Compression of a particle: c = max(rho/rho0 - 1, 0), walls' contribution included.
/// NaN: the scene does not define the measure.
struct Diagnostics {
  double time = 0;  ///< s
  std::int64_t update = 0;
  double compression_mean = 0;           ///< 1
  double compression_rms = 0;            ///< 1
  double compression_p99 = 0;            ///< 1, 99 % of the particles are at or below it
  double compression_max = 0;            ///< 1
  double share_above_1 = 0;              ///< 1, of the particles compressed by more than 1 %
  double share_above_10 = 0;             ///< 1, by more than 10 %
  double height_kept = 0;                ///< 1, twice the height of the centre over the rest depth
  double hydrostatic_deviation = 0;      ///< 1, of the weight above eight levels, RMS
  double kinetic_energy = 0;             ///< J
  double potential_energy = 0;           ///< J, -m g.x relative to the domain's lower corner
  double energy = 0;                     ///< J, kinetic and potential above the box's lowest corner
  double energy_drift = 0;               ///< 1, (E - W - E0)/E0, W the work; EnergyTrack
  double energy_rise = 0;                ///< 1, largest rise over any earlier E - W, over E0
  double momentum[3] = {0, 0, 0};        ///< kg m/s
  double center_of_mass[3] = {0, 0, 0};  ///< m
  double speed_max = 0;                  ///< m/s
  double front[3] = {0, 0, 0};           ///< m, largest coordinate along each axis
  double penetration = 0;                ///< m, farthest that a particle is behind its clamp
  double neighbors_mean = 0;             ///< without the particle itself
  std::int64_t neighbors_max = 0;
  std::int64_t outside = 0;     ///< particles beyond a wall
  std::int64_t non_finite = 0;  ///< particles with a non-finite position or velocity
  /// Particles times updates, since the start, above solver.speed_limit (which were slowed down to
  /// it), or without one above guard.speed.
  std::int64_t fast = 0;
  std::int64_t iterations_done = 0;  ///< over the constraints since the start
  /// Particles times steps, since the start, that moved by more than kResolvedWay relative to a
  /// neighbour (kernels/relative_motion.h): there fluid may pass through fluid.
  std::int64_t unresolved = 0;
  double relative_way_max = 0;  ///< h, the longest such way in a step; 0: there was none
  bool moved = false;           ///< something moves by itself
  double power = 0;             ///< W, of what the motion of the tank adds to gravity
  double solid_work = 0;        ///< J, of moving obstacles since their loads were taken last
  double work = 0;              ///< J, of both since the start; WorkTrack
  /// Since the row before; filled by who writes rows.
  std::vector<WallLoad> loads{};
};

/// What an EnergyTrack knows: enough to go on from a checkpoint. J, rise 1.
struct EnergyHistory {
  bool started = false;
  double first = 0, lowest = 0, largest = 0, rise = 0;
  double work = 0, power = 0, time = 0;  ///< of the last measure: WorkTrack; s
};

/// Follows the work of prescribed motions: that of obstacles, which each update books, and that of
/// the tank, whose power is measured, straight between two measures.
class WorkTrack {
 public:
  explicit WorkTrack(const EnergyHistory& before = {})
      : work_(before.work), power_(before.power), time_(before.time) {}
  /// J, at a measure since the last one that was taken.
  double until(const Diagnostics& m) const {
    return work_ + m.solid_work + 0.5 * (power_ + m.power) * (m.time - time_);
  }
  /// A measure with which the interval of the loads ends.
  void take(const Diagnostics& m) {
    work_ = until(m);
    power_ = m.power;
    time_ = m.time;
  }

 private:
  double work_, power_, time_;
};

/// Follows the energy of one simulation from its first measure on, less the work of what moves by
/// itself: so whatever rises was made by the method. A start without energy (E0 at most 1e-12 of
/// the largest so far) is no scale; the largest so far is one then, and a rise of 1 says that all
/// of it was made by the method. Never infinite.
class EnergyTrack {
 public:
  explicit EnergyTrack(const EnergyHistory& before = {}) : h_(before) {
    h_.largest = std::max({h_.largest, h_.first, h_.lowest});
    if (!std::isfinite(h_.rise)) h_.rise = 1;  // of a checkpoint from before this rule
  }
  /// Fills m.energy_drift and m.energy_rise. To be called with every measure, in order.
  void follow(Diagnostics& m) {
    const double own = m.energy - m.work;
    if (!h_.started) h_.first = h_.lowest = h_.largest = own;
    h_.started = true;
    h_.largest = std::max(h_.largest, m.energy);
    h_.rise = std::max(h_.rise, relative(own - h_.lowest));
    h_.lowest = std::min(h_.lowest, own);
    m.energy_drift = relative(own - h_.first);
    m.energy_rise = h_.rise;
    h_.work = m.work;
    h_.power = m.power;
    h_.time = m.time;
  }
  const EnergyHistory& history() const { return h_; }

 private:
  double relative(double e) const {
    return e == 0 ? 0 : e / (h_.first > 1e-12 * h_.largest ? h_.first : h_.largest);
  }
  EnergyHistory h_;
};

MeasureConstants measure_constants(const Scene& scene, const Plan& plan);

/// Sums in the internal frame, after so many updates and steps -> Diagnostics in SI units and the
/// scene's axes (lib/solver/DIAGNOSTICS.md).
Diagnostics to_diagnostics(const MeasureSums& sums, const MeasureConstants& given,
                           const Scene& scene, const Plan& plan, std::int64_t update,
                           std::int64_t steps);

/// How a study sums a measure up over its window.
enum class Over { none, mean, rms, max, last };

struct Diagnostic {
  const char* name;  ///< of the column; the components of a vector end in _x, _y, _z
  const char* unit;  ///< "1": none
  const char* help;  ///< a phrase; empty for the further components of a vector
  Over over;         ///< none: not in a study's table
  bool summary;      ///< a column of a batch's summary.csv
  double (*number)(const Diagnostics&);  ///< null for a whole number
  std::int64_t (*integer)(const Diagnostics&) = nullptr;

  double value(const Diagnostics& m) const { return number ? number(m) : double(integer(m)); }
};

/// In the order of the log's columns.
const std::vector<Diagnostic>& diagnostics();

/// A line for each, with its unit.
std::string diagnostics_help();

}  // namespace pbf::inline solver_module
