// A process that does jobs of a batch, several at a time, and keeps its GPU ready for the next one.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "lib/campaign/child.h"
#include "lib/campaign/job_channel.h"

namespace pbf::campaign_module {

/// The command of this program that calls serve_jobs() with its standard input.
inline constexpr const char* kServeCommand = "serve-batch";

/// In the process that serves. Tells the other end of the channel `fd` what the first GPU has, then
/// does each job that comes with run(its arguments) on a thread of its own and tells how it ended.
/// Returns when no more jobs will come and all have ended.
void serve_jobs(int fd, const std::function<JobEnd(const std::vector<std::string>&)>& run);

/// The other end: such a process of a batch. Not copied.
class JobServer {
 public:
  /// device: the number of the GPU it uses, as this process counts them. Throws Error(unavailable)
  /// if no process can be started.
  explicit JobServer(int device);

  int device() const { return device_; }  ///< as given
  /// Whether it has said what it has, from when on it takes jobs until end().
  bool ready() const { return ready_; }
  bool ending() const { return ending_; }
  int devices() const { return devices_; }                     ///< GPUs that it sees
  std::int64_t free_bytes() const { return free_; }            ///< of its GPU, before the first job
  const std::set<std::size_t>& jobs() const { return jobs_; }  ///< under way
  /// 0 if it has the job; else an errno, as JobChannel::send(), which does not wait.
  int give(std::size_t job, const std::vector<std::string>& args);
  /// Takes what it has told since the last call: ended(job, end). Returns whether there was
  /// anything.
  bool look(const std::function<void(std::size_t, const JobEnd&)>& ended);
  /// Whether it is gone. What it has not told is lost: jobs() are those.
  bool gone() const { return channel_.gone(); }
  /// ": " and what it said, or how it ended; once it is gone.
  std::string last_words();
  void terminate() const { child_->terminate(); }
  void end();  ///< no more jobs; it ends after those under way
  int fd() const { return channel_.fd(); }

 private:
  JobServer(std::pair<JobChannel, JobChannel> ends, int device);

  const int device_;
  std::unique_ptr<Child> child_;
  JobChannel channel_;  // closed first: the child ends when it is
  bool ready_ = false, ending_ = false;
  int devices_ = 0;
  std::int64_t free_ = 0;
  std::set<std::size_t> jobs_;
};

}  // namespace pbf::campaign_module
