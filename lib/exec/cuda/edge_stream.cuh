// A second stream of a rank: passes for the rows at its cuts, and the exchange of these rows, run
// beside the passes for its other rows.
#pragma once

#include <cuda_runtime.h>

#include <utility>

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
    cudaStreamDestroy(stream_);
  }

  /// Launches of edges() are for the rows at the cuts, those of inner() for the others.
  template <class Edges, class Inner>
  void beside(Launcher& launcher, const Edges& edges, const Inner& inner) {
    const cudaEvent_t awaited = std::exchange(launcher.awaited, nullptr);
    follow(launcher.stream);
    std::swap(launcher.stream, stream_);
    launcher.alone = true;
    edges();
    std::swap(launcher.stream, stream_);
    PBF_CUDA_CHECK(cudaEventRecord(edges_, stream_));
    launcher.alone = true;
    inner();
    PBF_CUDA_CHECK(cudaStreamWaitEvent(launcher.stream, edges_, 0));
    launcher.alone = true;
    launcher.awaited = awaited;
    launcher.split = true;
  }
  /// exchange(stream), of rows at the cuts.
  template <class Exchange>
  void exchange(Launcher& launcher, const Exchange& exchange) {
    if (!launcher.split) follow(launcher.ready());
    exchange(stream_);
    PBF_CUDA_CHECK(cudaEventRecord(exchanged_, stream_));
    launcher.awaited = exchanged_;
  }

 private:
  void follow(cudaStream_t main) {
    PBF_CUDA_CHECK(cudaEventRecord(main_, main));
    PBF_CUDA_CHECK(cudaStreamWaitEvent(stream_, main_, 0));
  }
  cudaStream_t stream_ = nullptr;
  cudaEvent_t main_ = nullptr, edges_ = nullptr, exchanged_ = nullptr;
};

}  // namespace pbf::PBF_VARIANT
