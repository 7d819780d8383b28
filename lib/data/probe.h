// Reads gauges on the frames of a finished run, with the code that reads them in a run.
#pragma once

#include <string>

#include "lib/io/run_file.h"
#include "lib/io/table.h"
#include "lib/scene/scene.h"

namespace pbf::data_module {

/// The scene of a run with the gauges of a file (`gauges: [...]`) in place of its own; nothing of
/// it is compared. `path`: of the run file, for messages. Throws Error(bad_input) that names file,
/// line and remedy for whatever a scene with these gauges would be refused for, for other keys, and
/// for gauges that need more than frames hold: a pressure comes from what the iterations of an
/// update did.
Scene scene_with_gauges(const RunInfo& info, const std::string& path, const std::string& gauges);

struct Probed {
  Table table;
  std::string units;  ///< of its columns: "time_s=s, H_m=m"
};

/// A row per frame: time_s, then a column for each number, named as `to-csv --gauges` does, with
/// its unit: H_m, U_x_m_s, Q_kg_s, Q_total_kg. Frames hold what a run reads in its last digits, so
/// levels and velocities differ from those of the run at that update by rounding. A flow is the net
/// mass of the particles that are on another side than in the frame before, over the time between
/// the two; the first is missing, and particles that are in one of them alone do not count.
/// scene: of scene_with_gauges(), its files read (read_linked_files()). Throws Error(bad_input) for
/// frames without velocities or too few for these gauges.
Probed probe(const RunReader& file, const Scene& scene);

}  // namespace pbf::data_module
