// The table of `pbf batch`: one row per run, from what its folder holds.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lib/campaign/batch_jobs.h"
#include "lib/campaign/batch_list.h"

namespace pbf::inline campaign_module {

/// Why a run ended, from its exit code: finished, diverged, stopped, unavailable, ... "waiting":
/// not started.
std::string exit_reason(int code);

/// CSV: a comment "# units: column=unit, ..." of the columns that have one; then name, scene,
/// settings, a column of every key that the list or the grid sets, with its value, empty where a
/// run has the scene's own ("set.name" where the key has the name of another column), exit code,
/// reason, message, then the last row of the run's log (time, update, compression, energies, ...)
/// and its numbers of particles, frames and warnings, where it has a run file, and last `seconds`,
/// those of all its updates and their output. Only `seconds` depends on the machine.
std::string batch_summary(const std::vector<BatchMember>& members,
                          const std::map<std::string, JobEnd>& ends, const std::string& out);

}  // namespace pbf::inline campaign_module
