// A thread with a queue in front of it.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace pbf::inline base_module {

/// Does jobs on a thread of its own, in their order, until one throws; those behind it are dropped.
/// For one user at a time.
class Worker {
 public:
  /// Holds at most `most` large jobs, the one at work among them. Throws Error(unavailable).
  explicit Worker(int most);
  ~Worker() { join(); }
  /// False when a job has thrown. A large one waits for room.
  bool push(std::function<void()> job, bool large);
  void wait();  ///< until all jobs are done, or one has thrown
  void join();  ///< the same, and ends the thread
  bool ended() const { return !thread_.joinable(); }
  std::exception_ptr failure();  ///< what a job has thrown

 private:
  struct Job {
    std::function<void()> action;
    bool large;
  };
  void work();

  const int most_;
  std::mutex mutex_;  // of everything below
  std::condition_variable changed_;
  std::deque<Job> jobs_;  // the first one may be at work
  int large_ = 0;
  bool ending_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // last: starts when the rest is there
};

}  // namespace pbf::inline base_module
