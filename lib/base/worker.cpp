#include "lib/base/worker.h"

#include <utility>

#include "lib/base/start_thread.h"

namespace pbf::base_module {

Worker::Worker(int most) : most_(most), thread_(start_thread([this] { work(); })) {}

void Worker::work() {
  std::unique_lock lock(mutex_);
  while (!failure_) {
    changed_.wait(lock, [&] { return ending_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const Job& job = jobs_.front();
    lock.unlock();
    std::exception_ptr thrown;
    try {
      job.action();
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    large_ -= job.large;
    jobs_.pop_front();
    failure_ = thrown;
    if (failure_) jobs_.clear();
    changed_.notify_all();
  }
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
