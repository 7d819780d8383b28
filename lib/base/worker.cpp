#include "lib/base/worker.h"

#include <chrono>
#include <utility>

#include "lib/base/start_thread.h"

namespace pbf::base_module {

Worker::Worker(int most, WhenIdle when_idle)
    : most_(most), when_idle_(std::move(when_idle)), thread_(start_thread([this] { work(); })) {}

void Worker::work() {
  std::unique_lock lock(mutex_);
  bool idle = true;  // nothing was done yet
  while (!failure_) {
    const auto comes = [&] { return ending_ || !jobs_.empty(); };
    if (idle || !when_idle_.action) {
      changed_.wait(lock, comes);
    } else if (!changed_.wait_for(lock, std::chrono::duration<double>(when_idle_.seconds), comes)) {
      idle = true;
      act(lock, when_idle_.action);
      if (failure_) jobs_.clear();
      changed_.notify_all();
      continue;
    }
    if (jobs_.empty()) return;
    idle = false;
    const Job& job = jobs_.front();
    act(lock, job.action);
    large_ -= job.large;
    jobs_.pop_front();
    if (failure_) jobs_.clear();
    changed_.notify_all();
  }
}

void Worker::act(std::unique_lock<std::mutex>& lock, const std::function<void()>& action) {
  lock.unlock();
  std::exception_ptr thrown;
  try {
    action();
  } catch (...) {
    thrown = std::current_exception();
  }
  lock.lock();
  failure_ = thrown;
}

bool Worker::push(std::function<void()> job, bool large) {
  std::unique_lock lock(mutex_);
  if (large) changed_.wait(lock, [&] { return failure_ || large_ < most_; });
  if (failure_) return false;
  large_ += large;
  jobs_.push_back({std::move(job), large});
  changed_.notify_all();
  return true;
}

void Worker::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return failure_ || jobs_.empty(); });
}

void Worker::join() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

std::exception_ptr Worker::failure() {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace pbf::base_module
