// A thread with a queue in front of it.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace pbf::base_module {

/// What a Worker does once when no job has come for so long after the last one.
struct WhenIdle {
  double seconds = 0;
  std::function<void()> action{};
};

/// Runs jobs in order on its own thread until one throws; later jobs are dropped. Its functions
/// must not be called by several threads at a time.
class Worker {
 public:
  /// Holds at most `most` large jobs, including the running one. Throws Error(unavailable).
  explicit Worker(int most, WhenIdle when_idle = {});
  ~Worker() { join(); }
  /// Adds a job; waits for room if it is large. False if a job has thrown.
  bool push(std::function<void()> job, bool large);
  void wait();  ///< until all jobs are done, or one has thrown
  void join();  ///< the same, and ends the thread
  bool ended() const { return !thread_.joinable(); }
  std::exception_ptr failure();  ///< the exception of a job, or null

 private:
  struct Job {
    std::function<void()> action;
    bool large;
  };
  void work();
  /// Without the lock; keeps what `action` throws.
  void act(std::unique_lock<std::mutex>& lock, const std::function<void()>& action);

  const int most_;
  const WhenIdle when_idle_;
  std::mutex mutex_;  // protects everything below
  std::condition_variable changed_;
  std::deque<Job> jobs_;  // the first one may be running
  int large_ = 0;
  bool ending_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // last: it uses the other members
};

}  // namespace pbf::base_module
