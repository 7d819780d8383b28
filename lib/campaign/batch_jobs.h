// The jobs of `pbf batch` in other processes, with limits on how many run at the same time: each in
// a process of its own, or several in one that keeps its GPU ready (job_server.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lib/campaign/child.h"

namespace pbf::campaign_module {

/// What a job takes, as `pbf plan` forecasts it.
struct JobNeeds {
  bool shares = false;    ///< a process with others
  bool device = false;    ///< needs a GPU
  bool pictures = false;  ///< draws some
  std::int64_t particles = 0, host_bytes = 0, device_bytes = 0;
};

/// How many run at the same time.
struct JobLimits {
  int alone = 1;   ///< in processes of their own
  int shared = 8;  ///< in each process that several share: one on the CPU, one for each GPU
  /// There, another one starts while those under way have fewer particles than this together: more
  /// would only wait for each other.
  std::int64_t particles = 300000;
};

struct JobCalls {
  std::function<std::vector<std::string>(std::size_t)> args;  ///< of a job
  std::function<bool()> stop;                                 ///< whether no more shall start
  std::function<void(std::size_t, const JobEnd&)> ended;      ///< called after each job
  std::function<void(const std::string&)> note;               ///< what went wrong, for people
};

/// Runs this program with other arguments in other processes. They get SIGTERM when this one ends,
/// in any way. Starts the jobs 0 .. needs.size() - 1. Once stop() is true, starts no more, sends
/// SIGTERM once to all and waits for them. Jobs that share a process lose nothing by each other:
/// what was under way in one that died, or ended there with an error of the program, the machine or
/// its files, is run again by itself when the others have ended, and that end counts. Throws
/// Error(unavailable) if no process can be started.
void run_jobs(const JobLimits& limits, const std::vector<JobNeeds>& needs, const JobCalls& calls);

}  // namespace pbf::campaign_module
