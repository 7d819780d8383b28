// The diagnostics of a run (scalars over all particles) and their table. The log of the run file,
// the lines of --log-json, the measures of a study, the summary of a batch, the help and the plan
// follow from the table. Formulas: lib/solver/DIAGNOSTICS.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pbf::inline program_module {

/// What a row of the log has besides diagnostics.
inline constexpr const char* kRowNumbers[] = {"time", "dt", "update", "iterations"};

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
  bool moved = false;           ///< obstacles or the tank have a prescribed motion
  double power = 0;             ///< W, of the inertial forces by the tank's motion
  double solid_work = 0;        ///< J, of moving obstacles in the current interval of loads
  double work = 0;              ///< J, of obstacles and tank since the start; WorkTrack
  /// Of Series::measures (lib/program/column.h), since the previous row. Watch fills them in.
  std::vector<double> readings{};
};

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
const std::vector<Diagnostic>& diagnostics();

/// A line for each, with its unit.
std::string diagnostics_help();

}  // namespace pbf::inline program_module
