// The report of a run: one JSON line per measurement.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/solver/diagnostics.h"
#include "lib/solver/solver.h"

namespace pbf::inline run_module {

/// 0 of nothing.
inline double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

/// One JSON object on one line: the measures, wall-clock seconds, frames that are safe on the disk,
/// seconds per stage.
std::string measure_json(const Diagnostics& measures, double wall, std::int64_t frames,
                         const std::vector<StageTime>& stages);

}  // namespace pbf::inline run_module
