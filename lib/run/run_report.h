// The report of a run: one JSON line per measurement.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/solver/diagnostics.h"
#include "lib/solver/solver.h"

namespace pbf::run_module {

/// Percentage of `part` in `whole`; 0 if `whole` is 0.
inline double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

/// One JSON object on one line: measurements, wall-clock seconds, frames that are safely on disk,
/// seconds per stage. `columns`: of the run's readings.
std::string measure_json(const Diagnostics& measures, double wall, std::int64_t frames,
                         const std::vector<StageTime>& stages,
                         const std::vector<ReadingColumn>& columns);

}  // namespace pbf::run_module
