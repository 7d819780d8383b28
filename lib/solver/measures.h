// What a run reports about its own state: scalars over all particles.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pbf::inline solver_module {

/// SI units. Compression of a particle: c = max(rho/rho0 - 1, 0), walls' contribution included.
/// Formulas: DIAGNOSTICS.md beside this file. NaN: the scene does not define the measure.
struct Measures {
  double time = 0;  ///< s
  std::int64_t update = 0;
  double compression_mean = 0;       ///< 1
  double compression_rms = 0;        ///< 1
  double compression_p99 = 0;        ///< 1, 99 % of the particles are at or below it
  double compression_max = 0;        ///< 1
  double share_above_1 = 0;          ///< 1, of the particles compressed by more than 1 %
  double share_above_10 = 0;         ///< 1, by more than 10 %
  double height_kept = 0;            ///< 1, twice the height of the centre over the rest depth
  double hydrostatic_deviation = 0;  ///< 1, of the weight above eight levels, RMS
  double kinetic_energy = 0;         ///< J
  double potential_energy = 0;       ///< J, -m g.x relative to the domain's lower corner
  double energy = 0;                 ///< J, kinetic and potential above the box's lowest corner
  double energy_drift = 0;           ///< 1, (E - E0)/E0; EnergyTrack
  double energy_rise = 0;            ///< 1, largest rise over any earlier E, over E0; EnergyTrack
  double momentum[3] = {0, 0, 0};    ///< kg m/s
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
  std::int64_t sweeps = 0;  ///< over the constraints since the start
  /// Particles times steps, since the start, that moved by more than kResolvedWay relative to a
  /// neighbour (kernels/relative_motion.h): there fluid may pass through fluid.
  std::int64_t unresolved = 0;
  double relative_way_max = 0;  ///< h, the longest such way in a step; 0: there was none
};

/// What an EnergyTrack knows: enough to go on from a checkpoint. J, rise 1.
struct EnergyHistory {
  bool started = false;
  double first = 0, lowest = 0, largest = 0, rise = 0;
};

/// Follows the energy of one simulation from its first measure on. The walls do not move and do no
/// work, so whatever rises was made by the method. A start without energy (E0 at most 1e-12 of the
/// largest so far) is no scale; the largest so far is one then, and a rise of 1 says that all of it
/// was made by the method. Never infinite.
class EnergyTrack {
 public:
  explicit EnergyTrack(const EnergyHistory& before = {}) : h_(before) {
    h_.largest = std::max({h_.largest, h_.first, h_.lowest});
    if (!std::isfinite(h_.rise)) h_.rise = 1;  // of a checkpoint from before this rule
  }
  /// Fills m.energy_drift and m.energy_rise. To be called with every measure, in order.
  void follow(Measures& m) {
    if (!h_.started) h_.first = h_.lowest = h_.largest = m.energy;
    h_.started = true;
    h_.largest = std::max(h_.largest, m.energy);
    h_.rise = std::max(h_.rise, relative(m.energy - h_.lowest));
    h_.lowest = std::min(h_.lowest, m.energy);
    m.energy_drift = relative(m.energy - h_.first);
    m.energy_rise = h_.rise;
  }
  const EnergyHistory& history() const { return h_; }

 private:
  double relative(double e) const {
    return e == 0 ? 0 : e / (h_.first > 1e-12 * h_.largest ? h_.first : h_.largest);
  }
  EnergyHistory h_;
};

}  // namespace pbf::inline solver_module
