// The CUDA executor: one stream; a thread per particle, or several for a neighbour sum where there
// are few particles.
#pragma once

#include <cub/device/device_scan.cuh>
#include <vector>

#include "kernels/pass_measure.h"
#include "lib/base/stage_clock.h"
#include "lib/cuda/device_buffer.h"
#include "lib/cuda/list_pass.cuh"

namespace pbf::inline PBF_VARIANT {

constexpr int kBlock = 128;
/// How many threads share a neighbour sum, by number of particles, and up to which number eight
/// share the making of a list: measured on an H200 (kernels/PERFORMANCE.md).
constexpr int kSixteenLanes = 4000, kEightLanes = 12000, kFourLanes = 40000, kTwoLanes = 100000;

/// First statement of every kernel: it is set up while the kernel before it ends, and waits here
/// until that one is done (programmatic dependent launch, from sm_90 on). An explicit early trigger
/// would let its blocks take the places of blocks still to run: measured 28 % slower at 131 k
/// particles.
__device__ __forceinline__ void wait_for_previous() {
#if __CUDA_ARCH__ >= 900
  cudaGridDependencySynchronize();
#endif
}

template <class Pass>
__global__ void __launch_bounds__(kBlock) apply_kernel(int n, Pass pass) {
  wait_for_previous();
  const int i = blockIdx.x * kBlock + threadIdx.x;
  if (i < n) pass(i);
}

/// Sum over a block by a tree of fixed shape, one result per block.
template <class Pass>
__global__ void __launch_bounds__(kBlock) reduce_kernel(int n, Pass pass, MeasureSums* out) {
  wait_for_previous();
  __shared__ MeasureSums part[kBlock];
  const int i = blockIdx.x * kBlock + threadIdx.x;
  part[threadIdx.x] = i < n ? pass(i) : MeasureSums{};
  for (int half = kBlock / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) part[threadIdx.x].add(part[threadIdx.x + half]);
  }
  if (threadIdx.x == 0) out[blockIdx.x] = part[0];
}

/// The pass that gives a particle its bin, then its place among those of the bin in order of
/// arrival.
template <class First>
struct CountPass {
  First first;
  int *count, *arrival;
  __device__ void operator()(int i) const {
    first(i);
    arrival[i] = atomicAdd(&count[first.bin[i]], 1);
  }
};
struct PlacePass {
  const int *bin, *start, *arrival;
  int* slot;
  __device__ void operator()(int i) const { slot[start[bin[i]] + arrival[i]] = i; }
};
/// Moves the particles of a bin in the order of their index, which makes the sort stable and the
/// run reproducible: each one counts those of its bin that come before it.
template <class Gather>
struct StablePass {
  const int *bin, *start, *slot;
  Gather gather;
  __device__ void operator()(int k) const {
    const int i = slot[k], b = bin[i], end = start[b + 1];
    int place = start[b];
    for (int m = place; m < end; ++m) place += slot[m] < i ? 1 : 0;
    gather(i, place);
  }
};

/// A neighbour sum by several threads per particle.
template <int lanes, class Pass>
__global__ void __launch_bounds__(kBlock) lanes_kernel(int n, Pass pass) {
  wait_for_previous();
  sum_over_neighbors_by_lanes<lanes>(pass, blockIdx.x * kBlock + threadIdx.x, n);
}
template <class Real>
__global__ void __launch_bounds__(kBlock) list_lanes_kernel(ListPass<Real> pass) {
  wait_for_previous();
  pass.by_lanes(blockIdx.x * kBlock + threadIdx.x);
}

/// Up to so many particles and bins one block sorts them, with the counters in 48 KiB of shared
/// memory, which every device has.
constexpr int kSortThreads = 1024, kSortParticles = 3000, kSortBins = 12 * 1024;
/// Runs `first` (see CountPass) as well.
template <class First>
__global__ void __launch_bounds__(kSortThreads)
    small_sort_kernel(First first_pass, int n, int bins, int* arrival, int* slot, int* start) {
  wait_for_previous();
  extern __shared__ int count[];  // bins
  __shared__ int warp_sum[32];
  const int t = threadIdx.x;
  const int* bin = first_pass.bin;
  for (int b = t; b < bins; b += kSortThreads) count[b] = 0;
  __syncthreads();
  for (int i = t; i < n; i += kSortThreads) {
    first_pass(i);
    arrival[i] = atomicAdd(&count[bin[i]], 1);
  }
  __syncthreads();
  // Exclusive scan: a run of bins per thread (an odd number, against bank conflicts), then the
  // threads' sums within warps, then the warps'.
  const int run = ((bins + kSortThreads - 1) / kSortThreads) | 1;
  const int first = min(t * run, bins), last = min(first + run, bins);
  int sum = 0;
  for (int b = first; b < last; ++b) sum += count[b];
  int before = sum;
  for (int d = 1; d < 32; d *= 2) {
    const int other = __shfl_up_sync(0xffffffffu, before, d);
    if (t % 32 >= d) before += other;
  }
  if (t % 32 == 31) warp_sum[t / 32] = before;
  __syncthreads();
  if (t < 32) {
    const int mine = warp_sum[t];
    int all = mine;
    for (int d = 1; d < 32; d *= 2) {
      const int other = __shfl_up_sync(0xffffffffu, all, d);
      if (t >= d) all += other;
    }
    warp_sum[t] = all - mine;
  }
  __syncthreads();
  before += warp_sum[t / 32] - sum;
  for (int b = first; b < last; ++b) {
    const int mine = count[b];
    count[b] = start[b] = before;
    before += mine;
  }
  if (t == 0) start[bins] = n;
  __syncthreads();
  for (int i = t; i < n; i += kSortThreads) slot[count[bin[i]] + arrival[i]] = i;
}

class CudaExec {
 public:
  using Lists = TransposedLists;
  static constexpr std::size_t padding = 1;
  template <class T>
  using Buffer = DeviceBuffer<T>;

  /// capacity: entries per particle that the lists have room for at first (multiple of 4).
  explicit CudaExec(int capacity);
  ~CudaExec();
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
  void to_host(const T* from, std::size_t n, T* host) {
    PBF_CUDA_CHECK(cudaMemcpyAsync(host, from, n * sizeof(T), cudaMemcpyDeviceToHost, stream_));
    synchronize();
  }
  template <class T>
  void copy(const T* from, std::size_t n, T* to) {
    PBF_CUDA_CHECK(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDeviceToDevice, stream_));
  }

  template <class Pass>
  void for_each(int n, const Pass& pass) {
    if constexpr (requires { typename Pass::Sum; }) {
      if (n <= kSixteenLanes) return launch(lanes_kernel<16, Pass>, 16 * n, kBlock, 0, n, pass);
      if (n <= kEightLanes) return launch(lanes_kernel<8, Pass>, 8 * n, kBlock, 0, n, pass);
      if (n <= kFourLanes) return launch(lanes_kernel<4, Pass>, 4 * n, kBlock, 0, n, pass);
      if (n <= kTwoLanes) return launch(lanes_kernel<2, Pass>, 2 * n, kBlock, 0, n, pass);
    }
    launch(apply_kernel<Pass>, n, kBlock, 0, n, pass);
  }

  template <class Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    const int blocks = (n + kBlock - 1) / kBlock;
    partial_.resize(std::size_t(blocks));
    partial_host_.resize(std::size_t(blocks));
    launch(reduce_kernel<Pass>, n, kBlock, 0, n, pass, partial_.data());
    PBF_CUDA_CHECK(cudaMemcpyAsync(partial_host_.data(), partial_.data(), partial_.bytes(),
                                   cudaMemcpyDeviceToHost, stream_));
    synchronize();
    MeasureSums total;
    for (int b = 0; b < blocks; ++b) total.add(partial_host_.data()[b]);
    return total;
  }

  /// See CpuExec; `order` is room for the arrivals.
  template <class First, class Gather>
  void sort_by_bin(const char* stage, const First& first, int n, int bins, int* order, int* start,
                   const Gather& gather) {
    counts_.resize(std::size_t(bins) + 1);
    slot_.resize(std::size_t(n));
    if (n <= kSortParticles && bins <= kSortBins) {
      launch(small_sort_kernel<First>, kSortThreads, kSortThreads, std::size_t(bins) * sizeof(int),
             first, n, bins, order, slot_.data(), start);
    } else {
      PBF_CUDA_CHECK(cudaMemsetAsync(counts_.data(), 0, counts_.bytes(), stream_));
      for_each(n, CountPass<First>{first, counts_.data(), order});
      mark(stage);
      scan(bins + 1, start);
      for_each(n, PlacePass{first.bin, start, order, slot_.data()});
    }
    for_each(n, StablePass<Gather>{first.bin, start, slot_.data(), gather});
  }

  template <class Real>
  Lists build_lists(const Vec4<Real>* position, const int* bin_start, const Params<Real>& p) {
    const int stride = (p.n + 31) / 32 * 32;
    words_.resize(std::size_t(stride) * std::size_t(capacity_ / 4));
    count_.resize(std::size_t(p.n));
    const ListPass<Real> pass{
        p, position, bin_start, words_.data(), count_.data(), longest_.data(), stride, capacity_};
    if (p.n <= kFourLanes)
      launch(list_lanes_kernel<Real>, 8 * p.n, kBlock, 0, pass);
    else
      for_each(p.n, pass);
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
  /// Enough blocks of `block` threads for `threads`; from sm_90 on with programmatic dependent
  /// launch, which hides most of the time between two kernels.
  template <class... P, class... A>
  void launch(void (*kernel)(P...), int threads, int block, std::size_t shared, const A&... args) {
    if (threads == 0) return;
    cudaLaunchConfig_t config{};
    config.gridDim = dim3(unsigned((std::int64_t(threads) + block - 1) / block));
    config.blockDim = dim3(unsigned(block));
    config.dynamicSmemBytes = shared;
    config.stream = stream_;
    cudaLaunchAttribute overlap{};
    overlap.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    overlap.val.programmaticStreamSerializationAllowed = 1;
    config.attrs = &overlap;
    config.numAttrs = overlap_ ? 1 : 0;
    PBF_CUDA_CHECK(cudaLaunchKernelEx(&config, kernel, P(args)...));
  }
  /// Exclusive sums of the counts.
  void scan(int n, int* start);

  cudaStream_t stream_ = nullptr;
  bool overlap_ = false;  ///< the device knows programmatic dependent launch
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

}  // namespace pbf::inline PBF_VARIANT
