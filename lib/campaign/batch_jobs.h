// Child processes of `pbf batch`, some of them at a time.
#pragma once

#include <sys/types.h>

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

/// Runs this program with other arguments in processes of their own. A child gets SIGTERM when this
/// process ends, however that happens.
class JobPool {
 public:
  /// `jobs`: at most so many at a time.
  explicit JobPool(int jobs) : jobs_(static_cast<std::size_t>(jobs)) {}

  /// Starts job k for k = 0 .. count-1 with the arguments that args(k) gives, no more once stop()
  /// says so: what runs then gets SIGTERM once and is waited for. ended(k, end) after each. Throws
  /// Error(unavailable) when no process can be started.
  void run(std::size_t count, const std::function<std::vector<std::string>(std::size_t)>& args,
           const std::function<bool()>& stop,
           const std::function<void(std::size_t, const JobEnd&)>& ended);

 private:
  struct Job {
    pid_t pid;
    std::size_t index;
    int err;  // descriptor of what it writes to stderr
  };
  Job start(std::size_t index, const std::vector<std::string>& args) const;
  std::size_t jobs_;
};

}  // namespace pbf::inline campaign_module
