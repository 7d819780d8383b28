// Child processes of `pbf batch`, with a limit on how many run at the same time.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace pbf::campaign_module {

/// How a child ended.
struct JobEnd {
  int code = 0;         ///< exit code; 128 + signal when a signal ended it
  std::string message;  ///< the line after "pbf: error: " on stderr; may be empty
};

/// Runs this program with other arguments in child processes, at most `jobs` at a time. A child
/// gets SIGTERM when this process ends, in any way. Starts job k for k = 0 .. count-1 with the
/// arguments args(k). Once stop() is true, starts no more, sends SIGTERM once to the running jobs
/// and waits for them. Calls ended(k, end) after each job. Throws Error(unavailable) if no process
/// can be started.
void run_jobs(int jobs, std::size_t count,
              const std::function<std::vector<std::string>(std::size_t)>& args,
              const std::function<bool()>& stop,
              const std::function<void(std::size_t, const JobEnd&)>& ended);

}  // namespace pbf::campaign_module
