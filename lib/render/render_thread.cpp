// Pictures drawn beside the solver.
#include <fmt/core.h>
#include <exception>
#include <filesystem>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/stage_clock.h"
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
  Snapshot part{snapshot.update, snapshot.time, snapshot.count, {}, snapshot.bodies};
  for (const auto& field : snapshot.fields)
    if (field.name == "position" || field.name == about(color).field) part.fields.push_back(field);
  return part;
}

}  // namespace

RenderThread::RenderThread(const View& view)
    : color_(view.color), renderer_(view, 1), worker_(kWaiting + 1) {}

void RenderThread::into(const std::string& dir) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error)
    throw Error(ExitCode::io,
                dir + ": the folder of the pictures cannot be made: " + error.message());
  dir_ = dir;
}

void RenderThread::draw(const Snapshot& snapshot, std::int64_t index) {
  auto job = [this, index, part = needed_part(snapshot, color_)] {
    const Stopwatch watch;
    write_png(frame_path(dir_, index), renderer_.draw(part));
    seconds_ = seconds_ + watch.seconds();
  };
  const bool taken = !worker_.ended() && worker_.push(std::move(job), true);
  rethrow();
  if (!taken && !told_) throw Error(ExitCode::internal, "RenderThread::draw after finish");
}

void RenderThread::wait() {
  worker_.wait();
  rethrow();
}

void RenderThread::finish() {
  worker_.join();
  rethrow();
}

/// Throws what the thread has caught, once.
void RenderThread::rethrow() {
  const std::exception_ptr failure = worker_.failure();
  if (failure && !std::exchange(told_, true)) std::rethrow_exception(failure);
}

}  // namespace pbf::render_module
