// Columns of a batch's summary that say what gauges and loads were like. Their numbers:
// lib/data/summary.h.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lib/scene/scene.h"

namespace pbf::scene_module {

/// More are left out of a summary, unless the key `summary` names them.
inline constexpr std::size_t kMostSummaryColumns = 200;

enum class SummaryOf {
  largest,      ///< reading
  mean,         ///< over time
  window_peak,  ///< largest mean over 20 ms by size, with its sign, of what has this impulse
  window_mean,  ///< mean over time, of what has this impulse
  change,       ///< from the first time to the last
};

struct SummaryColumn {
  std::string name;   ///< "gauge/H/max", "gauge/U/x/mean", "load/post/force_x/max_20ms"
  std::string unit;   ///< of its number
  std::string path;   ///< of the reading, below /pbf: "gauges/H", "log/load/post/impulse_x"
  int component = 0;  ///< of a velocity
  SummaryOf of = SummaryOf::largest;
  bool means = false;  ///< each reading is the mean since the one before
};

/// All that a scene can have, along the axes of its dimensions: gauge after gauge, then walls and
/// obstacles.
std::vector<SummaryColumn> summary_columns(const Scene& scene);
/// Those that its key `summary` names; without it all, or none if they are too many.
std::vector<SummaryColumn> wanted_summary_columns(const Scene& scene);

}  // namespace pbf::scene_module
