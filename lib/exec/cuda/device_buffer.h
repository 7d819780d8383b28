// Owning arrays: in device memory, and in pinned host memory for asynchronous copies.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <utility>

#include "lib/exec/cuda/check.h"

namespace pbf::exec_module {

/// Contents undefined after resize. resize throws Error(unavailable) when memory is short.
template <class T, bool pinned_host = false>
class CudaBuffer {
 public:
  CudaBuffer() = default;
  CudaBuffer(CudaBuffer&& o) noexcept { swap(o); }
  CudaBuffer& operator=(CudaBuffer&& o) noexcept {
    swap(o);
    return *this;
  }
  ~CudaBuffer() { release(); }

  void resize(std::size_t n) {
    if (n == size_) return;
    release();
    if (n == 0) return;
    void* p = nullptr;
    if constexpr (pinned_host)
      PBF_CUDA_CHECK(cudaMallocHost(&p, n * sizeof(T)));
    else
      PBF_CUDA_CHECK(cudaMalloc(&p, n * sizeof(T)));
    data_ = static_cast<T*>(p);
    size_ = n;
  }
  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }

 private:
  void release() {
    if (data_) {
      if constexpr (pinned_host)
        cudaFreeHost(data_);
      else
        cudaFree(data_);
    }
    data_ = nullptr;
    size_ = 0;
  }
  void swap(CudaBuffer& o) {
    std::swap(data_, o.data_);
    std::swap(size_, o.size_);
  }
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

template <class T>
using DeviceBuffer = CudaBuffer<T>;
template <class T>
using PinnedBuffer = CudaBuffer<T, true>;

/// Runs a device-wide algorithm of CUB: call(scratch, bytes) returns the bytes that it needs if
/// `scratch` is null, and runs otherwise.
template <class Call>
void with_scratch(DeviceBuffer<char>& scratch, const Call& call) {
  std::size_t bytes = 0;
  PBF_CUDA_CHECK(call(nullptr, bytes));
  if (scratch.size() < bytes) scratch.resize(bytes);
  PBF_CUDA_CHECK(call(scratch.data(), bytes));
}

}  // namespace pbf::exec_module
