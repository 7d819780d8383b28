// What a run says about itself: summary, table of stages, one JSON line per measure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lib/program/time_levels.h"
#include "lib/solver/measures.h"
#include "lib/solver/solver.h"

namespace pbf::inline run_module {

/// Everything the summary needs.
struct RunTotals {
  std::int64_t particles = 0, updates = 0;
  std::int64_t first_update = 0;  ///< a resumed run went on from there
  double simulated = 0;           ///< s
  double wall = 0;                ///< s, the whole command
  double loop = 0;                ///< s, the updates with their output
  std::vector<StageTime> stages;  ///< of the solver, then write and render
  double render_thread = 0;       ///< s, spent drawing beside the run
  bool fused = true;              ///< density summed in lambda's loop
  Measures first, last;
  double speed_limit = 0;            ///< m/s, 0: none
  double tolerance = 0;              ///< mean compression, 0: none
  int substeps = 1, max_sweeps = 0;  ///< per update; per substep
  double step = 0;                   ///< s, time.step
  std::optional<StepHistory> steps;  ///< with time.adaptive; its `updates` up to the end
  double compression_max = 0;        ///< largest over all measures
  std::int64_t frames = 0, pictures = 0, bytes = 0;
  std::string folder;
};

/// Seconds per stage with percent of the wall time; what no stage booked is "other".
std::string stage_table(const RunTotals& totals);

/// The same folded into seven groups, initialization ... post-processing.
std::string group_table(const RunTotals& totals);

std::string run_summary(const RunTotals& totals);

/// One JSON object on one line: the measures, wall-clock seconds, frames that are safe on the disk,
/// seconds per stage.
std::string measure_json(const Measures& measures, double wall, std::int64_t frames,
                         const std::vector<StageTime>& stages);

}  // namespace pbf::inline run_module
