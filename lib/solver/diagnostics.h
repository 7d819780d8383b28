// Diagnostics from the sums over particles, and what follows from several measurements. Formulas:
// DIAGNOSTICS.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernels/measure.h"
#include "lib/program/diagnostics.h"
#include "lib/program/plan.h"

namespace pbf::inline solver_module {

/// The state of an EnergyTrack and a WorkTrack, as a checkpoint stores it. J; rise: 1.
struct EnergyHistory {
  bool started = false;
  double first = 0, lowest = 0, largest = 0, rise = 0;
  double work = 0, power = 0, time = 0;  ///< at the last measurement: WorkTrack; s
};

/// Follows the work of prescribed motions. Updates book the work of obstacles; the power of the
/// tank's motion is measured and assumed linear between two measurements.
class WorkTrack {
 public:
  explicit WorkTrack(const EnergyHistory& before = {})
      : work_(before.work), power_(before.power), time_(before.time) {}
  /// J, the work up to measurement m.
  double until(const Diagnostics& m) const {
    return work_ + m.solid_work + 0.5 * (power_ + m.power) * (m.time - time_);
  }
  /// To be called with each measurement at which the interval of the loads ends.
  void take(const Diagnostics& m) {
    work_ = until(m);
    power_ = m.power;
    time_ = m.time;
  }

 private:
  double work_, power_, time_;
};

/// Follows E - W from the first measurement on: the energy without the work of prescribed motions,
/// so only the numerical method can make it rise. If the start has no energy (E0 at most 1e-12 of
/// the largest E so far), drift and rise are relative to the largest E so far. A rise of 1 then
/// means that the method created all of it. The results are always finite.
class EnergyTrack {
 public:
  explicit EnergyTrack(const EnergyHistory& before = {}) : h_(before) {
    h_.largest = std::max({h_.largest, h_.first, h_.lowest});
    if (!std::isfinite(h_.rise)) h_.rise = 1;  // older checkpoints may contain infinity
  }
  /// Fills m.energy_drift and m.energy_rise. To be called with every measurement, in order.
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

/// Converts sums in the internal frame to diagnostics in SI units along the scene's axes
/// (DIAGNOSTICS.md). update, steps: done so far.
Diagnostics to_diagnostics(const MeasureSums& sums, const MeasureConstants& given,
                           const Scene& scene, const Plan& plan, std::int64_t update,
                           std::int64_t steps);

}  // namespace pbf::inline solver_module
