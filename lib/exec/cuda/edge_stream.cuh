// A second stream, for launches beside those of the first. A rank has passes for the rows at its
// cuts there, and the exchange of these rows, beside the passes for its other rows.
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "lib/exec/cuda/kernel_start.cuh"

namespace pbf::PBF_VARIANT {

/// Launches of both streams see what the host has launched before, as in one stream, but for rows
/// that are not at a cut: these do not wait for an exchange, since they have no ghosts as
/// neighbors.
class EdgeStream {
 public:
  EdgeStream() {
    int least = 0, greatest = 0;
    PBF_CUDA_CHECK(cudaDeviceGetStreamPriorityRange(&least, &greatest));
    PBF_CUDA_CHECK(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, greatest));
    for (cudaEvent_t* e : {&main_, &edges_, &exchanged_})
      PBF_CUDA_CHECK(cudaEventCreateWithFlags(e, cudaEventDisableTiming));
  }
  EdgeStream(const EdgeStream&) = delete;
  EdgeStream& operator=(const EdgeStream&) = delete;
  ~EdgeStream() {
    for (cudaEvent_t e : {main_, edges_, exchanged_}) cudaEventDestroy(e);
    for (const Timed& t : timed_)
      for (cudaEvent_t e : {t.begin, t.end, t.arrived}) cudaEventDestroy(e);
    cudaStreamDestroy(stream_);
  }

  /// Launches of edges() are for the rows at the cuts, those of inner() for the others.
  template <class Edges, class Inner>
  void beside(Launcher& launcher, const Edges& edges, const Inner& inner) {
    const cudaEvent_t awaited = std::exchange(launcher.awaited, nullptr);
    follow(launcher.stream);
    launch_aside(launcher, edges);
    inner();
    launcher.note_arrival();
    PBF_CUDA_CHECK(cudaStreamWaitEvent(launcher.stream, edges_, 0));
    launcher.alone = true;
    launcher.awaited = awaited;
    launcher.split = true;
  }
  /// Launches small() beside large(). What is launched next waits for both, unless
  /// Launcher::meanwhile() launches it.
  template <class Small, class Large>
  void ahead(Launcher& launcher, const Small& small, const Large& large) {
    follow(launcher.ready());
    launch_aside(launcher, small);
    large();
    launcher.awaited = edges_;
  }
  /// exchange(stream), of rows at the cuts.
  template <class Exchange>
  void exchange(Launcher& launcher, const Exchange& exchange) {
    if (!launcher.split) follow(launcher.ready());
    Timed* t = watching_ ? &next() : nullptr;
    if (t) PBF_CUDA_CHECK(cudaEventRecord(t->begin, stream_));
    exchange(stream_);
    if (t) PBF_CUDA_CHECK(cudaEventRecord(t->end, stream_));
    PBF_CUDA_CHECK(cudaEventRecord(exchanged_, stream_));
    launcher.note_arrival();  // at the exchange before, if nothing has needed that
    launcher.awaited = exchanged_;
    launcher.arrived = t ? t->arrived : nullptr;
  }
  /// Times the exchanges of one update(). wait(): for the streams.
  template <class Update, class Wait>
  void watch(const Update& update, const Wait& wait) {
    watching_ = true;
    used_ = 0;
    update();
    watching_ = false;
    wait();
    for (std::size_t k = 0; k < used_; ++k) {
      float whole = 0, waited = 0;
      PBF_CUDA_CHECK(cudaEventElapsedTime(&whole, timed_[k].begin, timed_[k].end));
      PBF_CUDA_CHECK(cudaEventElapsedTime(&waited, timed_[k].arrived, timed_[k].end));
      hidden_ += 1e-3 * double(whole - std::clamp(waited, 0.0f, whole));
    }
    ++watched_;
  }
  /// s, in an update: how long exchanges ran while the other stream had something else to do.
  double hidden() const { return watched_ > 0 ? hidden_ / watched_ : 0; }

 private:
  /// Of an exchange: when it began and ended, and when the other stream came to need it.
  struct Timed {
    cudaEvent_t begin = nullptr, end = nullptr, arrived = nullptr;
  };
  Timed& next() {
    if (used_ == timed_.size()) {
      Timed& t = timed_.emplace_back();
      for (cudaEvent_t* e : {&t.begin, &t.end, &t.arrived}) PBF_CUDA_CHECK(cudaEventCreate(e));
    }
    return timed_[used_++];
  }
  /// Launches on this stream, and records edges_ behind it. The next launch on the other one is
  /// alone.
  template <class Launches>
  void launch_aside(Launcher& launcher, const Launches& launches) {
    launcher.alone = true;
    std::swap(launcher.stream, stream_);
    launches();
    std::swap(launcher.stream, stream_);
    launcher.alone = true;
    PBF_CUDA_CHECK(cudaEventRecord(edges_, stream_));
  }
  void follow(cudaStream_t main) {
    PBF_CUDA_CHECK(cudaEventRecord(main_, main));
    PBF_CUDA_CHECK(cudaStreamWaitEvent(stream_, main_, 0));
  }
  cudaStream_t stream_ = nullptr;
  cudaEvent_t main_ = nullptr, edges_ = nullptr, exchanged_ = nullptr;
  bool watching_ = false;
  std::vector<Timed> timed_;  ///< of the watched update the first `used_`
  std::size_t used_ = 0;
  double hidden_ = 0;  ///< s, in `watched_` updates
  int watched_ = 0;
};

}  // namespace pbf::PBF_VARIANT
