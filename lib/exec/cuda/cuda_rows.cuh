// The stream of the CUDA executor, copies of its memory, and what rows of ranks need
// (lib/exec/ranks/rank_rows.h).
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "lib/exec/cuda/device_buffer.h"
#include "lib/exec/cuda/device_link.h"
#include "lib/exec/cuda/kernel_start.cuh"

namespace pbf::PBF_VARIANT {

class CudaRows {
 public:
  void synchronize() { PBF_CUDA_CHECK(cudaStreamSynchronize(launcher_.stream)); }
  template <class T>
  void to_device(const T* host, std::size_t n, T* to) {
    PBF_CUDA_CHECK(
        cudaMemcpyAsync(to, host, n * sizeof(T), cudaMemcpyHostToDevice, launcher_.stream));
    synchronize();
  }
  template <class T>
  void to_host(const T* from, std::size_t n, T* host) {
    PBF_CUDA_CHECK(
        cudaMemcpyAsync(host, from, n * sizeof(T), cudaMemcpyDeviceToHost, launcher_.stream));
    synchronize();
  }

  // See CpuRows.

  void exchange(const std::vector<Outgoing>& out, const std::vector<Incoming>& in) {
    link_->exchange(out, in, launcher_.stream);
    launcher_.alone = true;  // kernels of others end without what wait_for_previous() waits for
  }
  void clear(char* at, std::size_t bytes) {
    PBF_CUDA_CHECK(cudaMemsetAsync(at, 0, bytes, launcher_.stream));
    launcher_.alone = true;
  }
  void copy(const char* from, char* to, std::size_t bytes) {
    if (bytes == 0) return;
    PBF_CUDA_CHECK(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, launcher_.stream));
    launcher_.alone = true;
  }
  void move_down(char* begin, std::size_t by, std::size_t bytes);
  template <std::size_t n>
  std::array<int, n> values(const int* from, const std::array<int, n>& at) {
    values_.resize(n);
    for (std::size_t k = 0; k < n; ++k)
      PBF_CUDA_CHECK(cudaMemcpyAsync(values_.data() + k, from + at[k], sizeof(int),
                                     cudaMemcpyDeviceToHost, launcher_.stream));
    synchronize();
    std::array<int, n> out;
    std::copy_n(values_.data(), n, out.begin());
    return out;
  }

 protected:
  Launcher launcher_;
  std::unique_ptr<DeviceLink> link_;

 private:
  PinnedBuffer<int> values_;
};

}  // namespace pbf::PBF_VARIANT
