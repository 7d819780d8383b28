// Pictures drawn beside the solver.
#include <fmt/core.h>
#include <atomic>
#include <exception>
#include <filesystem>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/stage_clock.h"
#include "lib/base/worker.h"
#include "lib/render/particles.h"
#include "lib/render/renderer.h"

namespace pbf::render_module {
namespace {

constexpr int kWaiting = 2;  // pictures; each holds a copy of its particles

std::string frame_path(const std::string& dir, std::int64_t index) {
  return std::filesystem::path(dir) / fmt::format("frame_{:06}.png", index);
}

/// The fields of a picture, without those that it does not read.
Snapshot needed_part(const Snapshot& snapshot, ColorBy color) {
  check_fields(snapshot, color);
  Snapshot part{snapshot.update, snapshot.time, snapshot.count, {}};
  for (const auto& field : snapshot.fields)
    if (field.name == "position" || field.name == about(color).field) part.fields.push_back(field);
  return part;
}

}  // namespace

struct RenderThread::Impl {
  std::string dir;
  ColorBy color;
  Renderer renderer;  // opened by the caller's thread, so that its errors come at once
  std::atomic<double> seconds = 0;
  bool told = false;            // of an error
  Worker worker{kWaiting + 1};  // last: its jobs use the rest

  explicit Impl(const View& view) : color(view.color), renderer(view, 1) {}

  void draw(const Snapshot& snapshot, std::int64_t index) {
    const Stopwatch watch;
    write_png(frame_path(dir, index), renderer.draw(snapshot));
    seconds = seconds + watch.seconds();
  }

  /// Throws what the thread has caught, once.
  void rethrow() {
    const std::exception_ptr failure = worker.failure();
    if (failure && !std::exchange(told, true)) std::rethrow_exception(failure);
  }
};

RenderThread::RenderThread(const View& view) : impl_(std::make_unique<Impl>(view)) {}

void RenderThread::into(const std::string& dir) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error)
    throw Error(ExitCode::io,
                dir + ": the folder of the pictures cannot be made: " + error.message());
  impl_->dir = dir;
}

RenderThread::~RenderThread() = default;

void RenderThread::draw(const Snapshot& snapshot, std::int64_t index) {
  Impl& i = *impl_;
  auto job = [&i, index, part = needed_part(snapshot, i.color)] { i.draw(part, index); };
  const bool taken = !i.worker.ended() && i.worker.push(std::move(job), true);
  i.rethrow();
  if (!taken && !i.told) throw Error(ExitCode::internal, "RenderThread::draw after finish");
}

void RenderThread::wait() {
  impl_->worker.wait();
  impl_->rethrow();
}

void RenderThread::finish() {
  impl_->worker.join();
  impl_->rethrow();
}

double RenderThread::seconds() const { return impl_->seconds; }

}  // namespace pbf::render_module
