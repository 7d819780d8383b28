// The CUDA executor: one stream; a thread per particle, or eight for neighbour sums where there are
// few particles.
#pragma once

#include <cub/device/device_scan.cuh>
#include <vector>

#include "kernels/pass_measure.h"
#include "lib/base/stage_clock.h"
#include "lib/cuda/device_buffer.h"
#include "lib/cuda/list_pass.cuh"

namespace pbf {

constexpr int kBlock = 128;
/// Up to so many particles eight threads share each neighbour sum.
constexpr int kFew = 60000;

template <class Pass>
__global__ void __launch_bounds__(kBlock) apply_kernel(int n, Pass pass) {
  const int i = blockIdx.x * kBlock + threadIdx.x;
  if (i < n) pass(i);
}

/// Sum over a block by a tree of fixed shape, one result per block.
template <class Pass>
__global__ void __launch_bounds__(kBlock) reduce_kernel(int n, Pass pass, MeasureSums* out) {
  __shared__ MeasureSums part[kBlock];
  const int i = blockIdx.x * kBlock + threadIdx.x;
  part[threadIdx.x] = i < n ? pass(i) : MeasureSums{};
  for (int half = kBlock / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) part[threadIdx.x].add(part[threadIdx.x + half]);
  }
  if (threadIdx.x == 0) out[blockIdx.x] = part[0];
}

/// The place of a particle among those of its bin, in order of arrival.
struct CountPass {
  const int* bin;
  int *count, *arrival;
  __device__ void operator()(int i) const { arrival[i] = atomicAdd(&count[bin[i]], 1); }
};
struct PlacePass {
  const int *bin, *start, *arrival;
  int* slot;
  __device__ void operator()(int i) const { slot[start[bin[i]] + arrival[i]] = i; }
};
/// Orders the particles of a bin by index, which makes the sort stable and the run reproducible:
/// each one counts those of its bin that come before it.
struct StablePass {
  const int *bin, *start, *slot;
  int* order;
  __device__ void operator()(int k) const {
    const int i = slot[k], c = bin[i], end = start[c + 1];
    int place = start[c];
    for (int m = place; m < end; ++m) place += slot[m] < i ? 1 : 0;
    order[place] = i;
  }
};

/// A neighbour sum by several threads per particle.
template <class Pass>
__global__ void __launch_bounds__(kBlock) lanes_kernel(int n, Pass pass) {
  sum_over_neighbors_by_lanes<8>(pass, blockIdx.x * kBlock + threadIdx.x, n);
}
template <class Real>
__global__ void __launch_bounds__(kBlock) lanes_kernel(ListPass<Real> pass) {
  pass.by_lanes(blockIdx.x * kBlock + threadIdx.x);
}

/// The whole stable counting sort in one block, for few particles and bins: `bins` counters in
/// shared memory. `order` holds the arrivals in between.
__global__ void small_sort_kernel(const int* bin, int n, int bins, int* order, int* slot,
                                  int* start);
constexpr int kSortThreads = 1024;
constexpr int kSortParticles = 16384, kSortBins = 48 * 1024;

class CudaExec {
 public:
  using Lists = TransposedLists;
  static constexpr std::size_t padding = 1;
  template <class T>
  using Buffer = DeviceBuffer<T>;

  /// capacity: entries per particle that the lists have room for at first (multiple of 4).
  explicit CudaExec(int capacity) : capacity_(capacity) {
    PBF_CUDA_CHECK(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
    longest_.resize(1);
    longest_host_.resize(1);
    clear_overflow();
  }
  ~CudaExec() {
    for (cudaEvent_t e : events_) cudaEventDestroy(e);
    if (stream_) cudaStreamDestroy(stream_);
  }
  CudaExec(const CudaExec&) = delete;
  CudaExec& operator=(const CudaExec&) = delete;

  cudaStream_t stream() const { return stream_; }
  void synchronize() { PBF_CUDA_CHECK(cudaStreamSynchronize(stream_)); }

  // Stage times: only where profiling is on, from events on the stream.
  void set_profiling(bool on) { profiling_ = on; }
  void begin();
  void mark(const char* stage);
  /// Books the marks since begin(), waiting for them; `scale` updates count as this one.
  void book(double scale);
  const StageClock& clock() const { return clock_; }

  template <class T>
  void to_device(const T* host, std::size_t n, T* to) {
    PBF_CUDA_CHECK(cudaMemcpyAsync(to, host, n * sizeof(T), cudaMemcpyHostToDevice, stream_));
    synchronize();
  }
  template <class T>
  void copy(const T* from, std::size_t n, T* to) {
    PBF_CUDA_CHECK(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDeviceToDevice, stream_));
  }

  template <class Pass>
  void for_each(int n, const Pass& pass) {
    if (n == 0) return;
    if constexpr (requires { typename Pass::Sum; }) {
      if (n <= kFew) {
        lanes_kernel<<<(8 * n + kBlock - 1) / kBlock, kBlock, 0, stream_>>>(n, pass);
        PBF_CUDA_CHECK(cudaGetLastError());
        return;
      }
    }
    apply_kernel<<<(n + kBlock - 1) / kBlock, kBlock, 0, stream_>>>(n, pass);
    PBF_CUDA_CHECK(cudaGetLastError());
  }

  template <class Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    const int blocks = (n + kBlock - 1) / kBlock;
    partial_.resize(std::size_t(blocks));
    partial_host_.resize(std::size_t(blocks));
    reduce_kernel<<<blocks, kBlock, 0, stream_>>>(n, pass, partial_.data());
    PBF_CUDA_CHECK(cudaGetLastError());
    PBF_CUDA_CHECK(cudaMemcpyAsync(partial_host_.data(), partial_.data(), partial_.bytes(),
                                   cudaMemcpyDeviceToHost, stream_));
    synchronize();
    MeasureSums total;
    for (int b = 0; b < blocks; ++b) total.add(partial_host_.data()[b]);
    return total;
  }

  /// Stable counting sort (see CpuExec).
  void sort_by_bin(const int* bin, int n, int bins, int* order, int* start);

  template <class Real>
  Lists build_lists(const Vec4<Real>* position, const int* bin_start, const Params<Real>& p) {
    const int stride = (p.n + 31) / 32 * 32;
    words_.resize(std::size_t(stride) * std::size_t(capacity_ / 4));
    count_.resize(std::size_t(p.n));
    const ListPass<Real> pass{
        p, position, bin_start, words_.data(), count_.data(), longest_.data(), stride, capacity_};
    if (p.n <= kFew) {
      lanes_kernel<<<(8 * p.n + kBlock - 1) / kBlock, kBlock, 0, stream_>>>(pass);
      PBF_CUDA_CHECK(cudaGetLastError());
    } else {
      for_each(p.n, pass);
    }
    return {words_.data(), count_.data(), stride};
  }

  // Lists that outgrow their room: the build records the longest one, nothing is written beyond
  // the room, and the caller repeats the updates with more.
  int capacity() const { return capacity_; }
  void set_capacity(int entries) {
    const std::size_t stride = words_.size() / std::size_t(capacity_ / 4);
    capacity_ = entries;
    words_.resize(0);  // first, so that the old and the new lists need not fit together
    words_.resize(stride * std::size_t(capacity_ / 4));
  }
  void clear_overflow();
  int overflow();  ///< waits; length of the longest list that did not fit, 0 when all did

  std::size_t list_bytes() const {
    return words_.bytes() + count_.bytes() + counts_.bytes() + slot_.bytes() + scan_.bytes() +
           partial_.bytes();
  }

 private:
  cudaStream_t stream_ = nullptr;
  int capacity_;
  bool profiling_ = false;
  StageClock clock_;
  std::vector<cudaEvent_t> events_;
  std::vector<const char*> stages_;  ///< of the marks since begin()
  DeviceBuffer<MeasureSums> partial_;
  PinnedBuffer<MeasureSums> partial_host_;
  DeviceBuffer<int4> words_;
  DeviceBuffer<int> count_, counts_, slot_, longest_;
  PinnedBuffer<int> longest_host_;
  DeviceBuffer<char> scan_;
};

}  // namespace pbf
