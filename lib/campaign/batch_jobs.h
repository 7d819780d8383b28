// Child processes of `pbf batch`, with a limit on how many run at the same time.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace pbf::inline campaign_module {

/// How a child ended.
struct JobEnd {
  int code = 0;         ///< exit code; 128 + signal when a signal ended it
  std::string message;  ///< after "pbf: error: " on its stderr, one line; empty when there is none
};

/// Runs this program with other arguments in processes of their own, at most `jobs` at a time. A
/// child gets SIGTERM when this process ends, however that happens. Starts job k for k = 0 ..
/// count-1 with the arguments that args(k) gives, no more once stop() says so: what runs then gets
/// SIGTERM once and is waited for. ended(k, end) after each. Throws Error(unavailable) when no
/// process can be started.
void run_jobs(int jobs, std::size_t count,
              const std::function<std::vector<std::string>(std::size_t)>& args,
              const std::function<bool()>& stop,
              const std::function<void(std::size_t, const JobEnd&)>& ended);

}  // namespace pbf::inline campaign_module
