// RunWriter: the queue and the thread in front of RunOutput.
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <variant>

#include "lib/base/error.h"
#include "lib/base/start_thread.h"
#include "lib/io/h5.h"
#include "lib/io/run_file.h"
#include "lib/io/run_output.h"

namespace pbf::inline io_module {

struct RunWriter::Impl {
  struct Sync {};
  using Job = std::variant<Snapshot, LogRow, Sync, RunEnding>;
  using Open = std::function<std::unique_ptr<RunOutput>()>;
  static constexpr int max_snapshots = 2;

  Impl(const std::string& path, const std::string& opening, const Open& open)
      : path_(path), thread_(start_thread([this, opening, open] { work(opening, open); })) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failure_ || created_; });
    if (!failure_) return;
    lock.unlock();
    thread_.join();
    std::rethrow_exception(failure_);
  }

  ~Impl() {
    if (!thread_.joinable()) return;
    push(RunEnding{"stopped", "", 0, {}});
    thread_.join();
  }

  /// Hands a job to the thread, a snapshot when there is room; false when the thread has failed.
  bool push(Job&& job) {
    std::unique_lock lock(mutex_);
    const bool snapshot = std::holds_alternative<Snapshot>(job);
    if (snapshot) changed_.wait(lock, [&] { return failure_ || snapshots_ < max_snapshots; });
    if (failure_) return false;
    snapshots_ += snapshot;
    queue_.push_back(std::move(job));
    changed_.notify_all();
    return true;
  }

  void push_or_throw(Job&& job) {
    if (thread_.joinable() && push(std::move(job))) return;
    if (failure_) std::rethrow_exception(failure_);
    throw Error(ExitCode::internal, path_ + ": written to after its end");
  }

  void sync() {
    push_or_throw(Sync{});
    std::unique_lock lock(mutex_);
    const std::int64_t mine = ++syncs_asked_;
    changed_.wait(lock, [&] { return failure_ || syncs_done_ >= mine; });
    if (failure_) std::rethrow_exception(failure_);
  }

  void finish(RunEnding&& end) {
    if (thread_.joinable()) {
      push(std::move(end));
      thread_.join();
    }
    if (failure_) std::rethrow_exception(failure_);
  }

  std::atomic<std::int64_t> frames_{0}, bytes_{0};

 private:
  Job pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !queue_.empty(); });
    Job job = std::move(queue_.front());
    queue_.pop_front();
    return job;
  }

  void popped_snapshot() {
    const std::lock_guard lock(mutex_);
    --snapshots_;
    changed_.notify_all();
  }

  /// Runs `action` on the file; a failure ends the file and is thrown as an Error that says what
  /// was tried, why it failed and what is kept.
  template <class Action>
  void on_file(const std::string& what, Action action) {
    const h5::Lock lock;
    try {
      action();
      bytes_ = out_->bytes();
      frames_ = out_->frames();
    } catch (const h5::Failure& f) {
      out_.reset();
      std::string kept;
      if (frames_ == 1) kept = "; frame 0 is kept";
      if (frames_ > 1) kept = "; frames 0.." + std::to_string(frames_ - 1) + " are kept";
      throw Error(ExitCode::io, path_ + ": " + what + ": " + f.what() + kept);
    } catch (...) {
      out_.reset();
      throw;
    }
  }

  void run_jobs() {
    for (;;) {
      Job job = pop();
      if (const auto* end = std::get_if<RunEnding>(&job)) {
        on_file("cannot finish the file", [&] { out_->close(*end); });
        const h5::Lock lock;
        out_.reset();
        return;
      }
      if (const auto* row = std::get_if<LogRow>(&job)) {
        on_file("cannot write the log", [&] { out_->log(*row); });
      } else if (std::holds_alternative<Sync>(job)) {
        on_file("cannot write the log", [&] { out_->sync(); });
        const std::lock_guard lock(mutex_);
        ++syncs_done_;
        changed_.notify_all();
      } else {
        on_file("cannot write frame " + std::to_string(frames_),
                [&] { out_->write_frame(std::get<Snapshot>(job)); });
        popped_snapshot();
      }
    }
  }

  void work(const std::string& opening, const Open& open) noexcept {
    try {
      on_file(opening, [&] { out_ = open(); });
      {
        const std::lock_guard lock(mutex_);
        created_ = true;
        changed_.notify_all();
      }
      run_jobs();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      queue_.clear();
      changed_.notify_all();
    }
  }

  const std::string path_;
  std::mutex mutex_;  // of everything below but out_
  std::condition_variable changed_;
  std::deque<Job> queue_;
  int snapshots_ = 0;  // waiting or being written
  std::int64_t syncs_asked_ = 0, syncs_done_ = 0;
  bool created_ = false;
  std::exception_ptr failure_;
  std::unique_ptr<RunOutput> out_;  // the thread's
  std::thread thread_;              // last: starts when the rest is there
};

RunWriter::RunWriter(const std::string& path, const RunInfo& info, bool gzip)
    : impl_(std::make_unique<Impl>(path, "cannot create the file",
                                   [=] { return std::make_unique<RunOutput>(path, info, gzip); })) {
}
RunWriter::RunWriter(const std::string& path, const RunInfo& info, bool gzip, std::int64_t frames,
                     std::int64_t rows)
    : impl_(std::make_unique<Impl>(path, "cannot go on in the file", [=] {
        return std::make_unique<RunOutput>(path, info, gzip, frames, rows);
      })) {}
RunWriter::~RunWriter() = default;
void RunWriter::write(Snapshot&& snapshot) { impl_->push_or_throw(std::move(snapshot)); }
void RunWriter::log(const LogRow& row) { impl_->push_or_throw(LogRow(row)); }
std::int64_t RunWriter::frames_written() const { return impl_->frames_; }
std::int64_t RunWriter::bytes_written() const { return impl_->bytes_; }
void RunWriter::sync() { impl_->sync(); }
void RunWriter::finish(const RunEnding& ending) { impl_->finish(RunEnding(ending)); }

}  // namespace pbf::inline io_module
