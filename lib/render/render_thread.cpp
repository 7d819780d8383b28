// Pictures drawn beside the solver.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/start_thread.h"
#include "lib/render/particles.h"
#include "lib/render/renderer.h"

namespace pbf::inline render_module {
namespace {

constexpr std::size_t kWaiting = 2;  // pictures; each holds a copy of its particles

std::string frame_path(const std::string& dir, std::int64_t index) {
  char name[40];
  std::snprintf(name, sizeof name, "frame_%06lld.png", static_cast<long long>(index));
  return (std::filesystem::path(dir) / name).string();
}

/// The fields of a picture, without those that it does not read.
Snapshot needed_part(const Snapshot& snapshot, ColorBy color) {
  check_fields(snapshot, color);
  Snapshot part{snapshot.update, snapshot.time, snapshot.count, {}};
  for (const auto& field : snapshot.fields)
    if (field.name == "position" || (field.name == "velocity" && color == ColorBy::speed) ||
        (field.name == "density" && color == ColorBy::density))
      part.fields.push_back(field);
  return part;
}

}  // namespace

struct RenderThread::Impl {
  std::string dir;
  ColorBy color;
  Renderer renderer;  // opened by the caller's thread, so that its errors come at once
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::pair<Snapshot, std::int64_t>> queue;
  std::exception_ptr error;
  bool failed = false, ending = false, busy = false;
  std::atomic<double> seconds = 0;
  std::thread thread;  // last: it uses all of the above

  Impl(const View& view, std::string folder)
      : dir(std::move(folder)),
        color(view.color),
        renderer(view, 1),
        thread(start_thread([this] { work(); })) {}

  void work() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [this] { return ending || !queue.empty(); });
      if (queue.empty()) return;
      const auto [snapshot, index] = std::move(queue.front());
      queue.pop_front();
      changed.notify_all();
      if (failed) continue;
      busy = true;
      lock.unlock();
      std::exception_ptr caught;
      const auto start = std::chrono::steady_clock::now();
      try {
        write_png(frame_path(dir, index), renderer.draw(snapshot));
      } catch (...) {
        caught = std::current_exception();
      }
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
      seconds = seconds + spent.count();
      lock.lock();
      busy = false;
      if (caught) {
        error = caught;
        failed = true;
      }
      changed.notify_all();
    }
  }

  /// With the lock held: throws what the thread has caught, once.
  void rethrow() {
    if (error) std::rethrow_exception(std::exchange(error, nullptr));
  }

  void join() {
    {
      const std::lock_guard lock(mutex);
      ending = true;
    }
    changed.notify_all();
    if (thread.joinable()) thread.join();
  }
};

RenderThread::RenderThread(const View& view, const std::string& dir) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error)
    throw Error(ExitCode::io,
                dir + ": the folder of the pictures cannot be made: " + error.message());
  impl_ = std::make_unique<Impl>(view, dir);
}

RenderThread::~RenderThread() {
  if (impl_) impl_->join();
}

void RenderThread::draw(const Snapshot& snapshot, std::int64_t index) {
  Snapshot part = needed_part(snapshot, impl_->color);
  std::unique_lock lock(impl_->mutex);
  impl_->changed.wait(lock, [this] { return impl_->queue.size() < kWaiting || impl_->failed; });
  impl_->rethrow();
  if (impl_->failed) return;
  if (impl_->ending) throw Error(ExitCode::internal, "RenderThread::draw after finish");
  impl_->queue.emplace_back(std::move(part), index);
  impl_->changed.notify_all();
}

void RenderThread::wait() {
  std::unique_lock lock(impl_->mutex);
  impl_->changed.wait(lock,
                      [this] { return (impl_->queue.empty() && !impl_->busy) || impl_->failed; });
  impl_->rethrow();
}

void RenderThread::finish() {
  impl_->join();
  const std::lock_guard lock(impl_->mutex);
  impl_->rethrow();
}

double RenderThread::seconds() const { return impl_->seconds; }

}  // namespace pbf::inline render_module
