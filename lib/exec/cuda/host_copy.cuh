// Downloads during updates: a second stream copies from a staging buffer to pinned memory.
#pragma once

#include <algorithm>
#include <vector>

#include "lib/exec/cuda/device_buffer.h"
#include "lib/exec/cuda/kernel_start.cuh"
#include "lib/solver/executor.h"

namespace pbf::PBF_VARIANT {

class HostCopy {
 public:
  HostCopy() = default;
  HostCopy(const HostCopy&) = delete;
  HostCopy& operator=(const HostCopy&) = delete;
  ~HostCopy() {
    if (!stream_) return;
    cudaStreamSynchronize(stream_);
    cudaEventDestroy(written_);
    cudaStreamDestroy(stream_);
  }

  /// write(pointers) fills the staging buffer, by launches.
  template <class Out, class Write>
  void start(const std::vector<CopyTarget>& to, const Write& write, Launcher& launcher) {
    std::size_t bytes = 0;
    for (const CopyTarget& t : to) bytes += t.bytes;
    if (!stream_) {
      PBF_CUDA_CHECK(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
      PBF_CUDA_CHECK(cudaEventCreateWithFlags(&written_, cudaEventDisableTiming));
    }
    if (staging_.size() < bytes) staging_.resize(bytes), host_.resize(bytes);
    std::vector<Out*> rows;
    for (char* at = staging_.data(); const CopyTarget& t : to) {
      rows.push_back(reinterpret_cast<Out*>(at));
      at += t.bytes;
    }
    write(rows);
    PBF_CUDA_CHECK(cudaEventRecord(written_, launcher.ready()));
    PBF_CUDA_CHECK(cudaStreamWaitEvent(stream_, written_, 0));
    PBF_CUDA_CHECK(
        cudaMemcpyAsync(host_.data(), staging_.data(), bytes, cudaMemcpyDeviceToHost, stream_));
  }

  /// Waits for the copy.
  void finish(const std::vector<CopyTarget>& to) {
    PBF_CUDA_CHECK(cudaStreamSynchronize(stream_));
    const char* from = host_.data();
    for (const CopyTarget& t : to) {
      std::copy_n(from, t.bytes, static_cast<char*>(t.host));
      from += t.bytes;
    }
  }

  std::size_t bytes() const { return staging_.bytes(); }

 private:
  cudaStream_t stream_ = nullptr;
  cudaEvent_t written_ = nullptr;
  DeviceBuffer<char> staging_;
  PinnedBuffer<char> host_;
};

}  // namespace pbf::PBF_VARIANT
