// RunWriter: the queue and the thread in front of RunOutput.
#include <atomic>
#include <functional>

#include "lib/base/error.h"
#include "lib/base/worker.h"
#include "lib/io/h5.h"
#include "lib/io/run_file.h"
#include "lib/io/run_layout.h"
#include "lib/io/run_output.h"

namespace pbf::io_module {

struct RunWriter::Impl {
  static constexpr int max_snapshots = 2;

  Impl(const std::string& path, const std::string& opening,
       const std::function<std::unique_ptr<RunOutput>()>& open)
      : path_(path), worker_(max_snapshots, {run_layout::commit_seconds, [this] { commit(); }}) {
    worker_.push([=, this] { on_file(opening, [&] { out_ = open(); }); }, false);
    worker_.wait();
    rethrow();
  }

  ~Impl() { end({"stopped", "", 0, {}}); }

  void push(std::function<void()> job, bool snapshot = false) {
    if (!worker_.ended() && worker_.push(std::move(job), snapshot)) return;
    rethrow();
    throw Error(ExitCode::internal, path_ + ": written to after its end");
  }

  /// action(the file) on the worker's thread.
  template <class Action>
  void later(const char* what, Action action) {
    push([=, this] { on_file(what, [&] { action(*out_); }); });
  }

  /// The same, and waits for it.
  template <class Action>
  void now(const std::string& what, const Action& action) {
    push([=, this] { on_file(what, [&] { action(*out_); }); });
    wait();
  }
  void wait() {
    worker_.wait();
    rethrow();
  }
  /// Frames that wait for it.
  void commit() {
    if (out_) on_file(frame(), [&] { out_->commit(); });
  }
  std::string frame() const { return "cannot write frame " + std::to_string(frames_); }

  void end(const RunEnding& ending) {
    if (worker_.ended()) return;
    const auto job = [&] {
      on_file("cannot finish the file", [&] { out_->close(ending); });
      const h5::Lock lock;
      out_.reset();
    };
    worker_.push(job, false);
    worker_.join();
  }

  void rethrow() {
    if (const std::exception_ptr failure = worker_.failure()) std::rethrow_exception(failure);
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
      if (out_) frames_ = out_->frames();
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

  std::atomic<std::int64_t> frames_{0}, bytes_{0};
  const std::string path_;
  std::unique_ptr<RunOutput> out_;  // the worker's
  Worker worker_;                   // last: its jobs use the rest
};

RunWriter::RunWriter(const std::string& path, const RunInfo& info, bool gzip)
    : impl_(std::make_unique<Impl>(path, "cannot create the file",
                                   [=] { return std::make_unique<RunOutput>(path, info, gzip); })) {
}
RunWriter::RunWriter(const std::string& path, const RunInfo& info, bool gzip, std::int64_t frames,
                     const KeptRows& rows)
    : impl_(std::make_unique<Impl>(path, "cannot go on in the file", [=] {
        return std::make_unique<RunOutput>(path, info, gzip, frames, rows);
      })) {}
RunWriter::~RunWriter() = default;
void RunWriter::write(Snapshot&& snapshot) {
  impl_->push(
      [i = impl_.get(), s = std::move(snapshot)] {
        i->on_file(i->frame(), [&] { i->out_->write_frame(s); });
      },
      true);
}
FramePlaces RunWriter::begin_frame(const Snapshot& head) {
  FramePlaces places;
  impl_->push([&, i = impl_.get()] {
    i->on_file(i->frame(), [&] { places = i->out_->begin_frame(head); });
  });
  impl_->wait();
  return places;
}
void RunWriter::rows(std::size_t field, std::int64_t first, FieldArray&& rows) {
  impl_->push(
      [i = impl_.get(), field, first, r = std::move(rows)] {
        i->on_file(i->frame(), [&] { i->out_->rows(field, first, r); });
      },
      true);
}
void RunWriter::commit_frame() {
  impl_->push([i = impl_.get()] { i->on_file(i->frame(), [&] { i->out_->commit_frame(); }); });
}
std::uint64_t RunWriter::inode() {
  std::uint64_t number = 0;
  impl_->now("cannot look at the file", [&](RunOutput& out) { number = out.inode(); });
  return number;
}
void RunWriter::log(const LogRow& row) {
  impl_->later("cannot write the log", [row](RunOutput& out) { out.log(row); });
}
void RunWriter::gauges(const GaugeRow& row) {
  impl_->later("cannot write the gauges", [row](RunOutput& out) { out.gauges(row); });
}
void RunWriter::sync() {
  impl_->now("cannot write the log", [](RunOutput& out) { out.sync(); });
}
std::int64_t RunWriter::frames_written() const { return impl_->frames_; }
std::int64_t RunWriter::bytes_written() const { return impl_->bytes_; }
void RunWriter::finish(const RunEnding& ending) {
  impl_->end(ending);
  impl_->rethrow();
}

}  // namespace pbf::io_module
