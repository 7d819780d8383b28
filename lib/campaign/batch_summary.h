// The table of `pbf batch`: one row per run, from the contents of its folder.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lib/campaign/batch_jobs.h"
#include "lib/campaign/batch_list.h"
#include "lib/campaign/run_results.h"
#include "lib/io/table.h"

namespace pbf::campaign_module {

/// Why a run ended, from its exit code: finished, diverged, stopped, unavailable, ...; "waiting" if
/// it has not started.
std::string exit_reason(int code);

/// As CSV a comment "# units: column=unit, ..." precedes the table. Columns: name, scene and
/// settings; one column per key that the list or the grid sets, empty if a run uses the value of
/// its scene ("set.name" if the key has the name of another column); exit code, reason and message;
/// from the run file, if any, the last row of the log (time, update, compression, energies, ...)
/// and the numbers of particles, frames and warnings; `seconds` of all updates with their output,
/// the only column that depends on the machine; gauges and loads (lib/scene/summary.h); comparisons
/// with measurements that some run has ("compare/H2/rms").
struct BatchSummary {
  Table table;
  std::vector<std::pair<std::string, std::string>> units;  ///< of columns that have one
  std::string note;  ///< what is left out of it, and the remedy; empty: nothing
  std::string csv() const;
  /// {"version", "units": {column: unit}, "rows": [{column: value}]}
  std::string json() const;
};
/// read: of the folder of the runs.
BatchSummary batch_summary(const std::vector<BatchMember>& members,
                           const std::map<std::string, JobEnd>& ends, RunResults& read);

}  // namespace pbf::campaign_module
