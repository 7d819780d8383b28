// The stream of the CUDA executor, copies of its memory, and what rows of ranks need
// (lib/exec/ranks/rank_rows.h).
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "lib/exec/cuda/device_buffer.h"
#include "lib/exec/cuda/device_link.h"
#include "lib/exec/cuda/edge_stream.cuh"
#include "lib/exec/cuda/kernels.cuh"

namespace pbf::PBF_VARIANT {

/// Single values from different places.
template <std::size_t n>
struct ReadIntsPass {
  std::array<const int*, n> from;
  int* to;
  PBF_HD void operator()(int k) const { to[k] = *from[std::size_t(k)]; }
};

class Event {
 public:
  Event() = default;
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event() {
    if (event_) cudaEventDestroy(event_);
  }
  void record(cudaStream_t stream) {
    if (!event_) PBF_CUDA_CHECK(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming));
    PBF_CUDA_CHECK(cudaEventRecord(event_, stream));
  }
  cudaEvent_t get() const { return event_; }

 private:
  cudaEvent_t event_ = nullptr;
};

class CudaRows {
 public:
  /// Waits for the stream. Meanwhile a rank answers others, and finds those that hang.
  void synchronize() {
    const cudaStream_t stream = launcher_.ready();
    link_ ? link_->wait(stream) : PBF_CUDA_CHECK(cudaStreamSynchronize(stream));
  }
  /// To be called before the host waits for the stream in another way, as copies from and to memory
  /// that is not pinned do.
  void before_waiting() {
    if (link_) synchronize();
  }
  template <class T>
  void to_device(const T* host, std::size_t n, T* to) {
    before_waiting();
    PBF_CUDA_CHECK(
        cudaMemcpyAsync(to, host, n * sizeof(T), cudaMemcpyHostToDevice, launcher_.ready()));
    synchronize();
  }
  template <class T>
  void to_host(const T* from, std::size_t n, T* host) {
    before_waiting();
    PBF_CUDA_CHECK(
        cudaMemcpyAsync(host, from, n * sizeof(T), cudaMemcpyDeviceToHost, launcher_.ready()));
    synchronize();
  }

  // See CpuRows.

  void exchange(const std::vector<Outgoing>& out, const std::vector<Incoming>& in) {
    link_->exchange(out, in, launcher_.ready());
    launcher_.alone = true;  // kernels of others end without what wait_for_previous() waits for
  }
  /// Of rows at the cuts: beside the passes of other rows, if the device exchanges on its own.
  void exchange_edges(const std::vector<Outgoing>& out, const std::vector<Incoming>& in) {
    if (!edges_) return exchange(out, in);
    edges_->exchange(launcher_, [&](cudaStream_t stream) { link_->exchange(out, in, stream); });
  }
  /// Whether the rows at cuts of so many are launched by themselves in passes beside an exchange:
  /// these must take longer than the additional launches.
  bool has_edges(int rows) const { return edges_ && rows >= 200000; }
  /// Launches edges() for the rows at the cuts, and inner() for the others.
  template <class Edges, class Inner>
  void beside(const Edges& edges, const Inner& inner) {
    edges_->beside(launcher_, edges, inner);
  }
  void clear(char* at, std::size_t bytes) {
    PBF_CUDA_CHECK(cudaMemsetAsync(at, 0, bytes, launcher_.ready()));
    launcher_.alone = true;
  }
  /// The same for memory that no exchange under way reads or writes, so that nothing waits for it.
  void clear_own(char* at, std::size_t bytes) {
    PBF_CUDA_CHECK(cudaMemsetAsync(at, 0, bytes, launcher_.stream));
    launcher_.alone = true;
  }
  void copy(const char* from, char* to, std::size_t bytes) {
    if (bytes == 0) return;
    PBF_CUDA_CHECK(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, launcher_.ready()));
    launcher_.alone = true;
  }
  void move_down(char* begin, std::size_t by, std::size_t bytes);
  std::vector<int> values(const int* from, int n) {
    make_room(std::size_t(n));
    PBF_CUDA_CHECK(cudaMemcpyAsync(values_.data(), from, std::size_t(n) * sizeof(int),
                                   cudaMemcpyDeviceToHost, launcher_.ready()));
    synchronize();
    return {values_.data(), values_.data() + n};
  }
  template <std::size_t n>
  void ask(const std::array<const int*, n>& from) {
    if (answers_.size() < n) answers_.resize(n);
    launcher_.start(item_kernel<int, ReadIntsPass<n>>, int(n), kBlock, 0, int(n),
                    ReadIntsPass<n>{from, answers_.data()});
    answered_.record(launcher_.ready());
  }
  template <std::size_t n>
  std::array<int, n> answer() {
    link_->wait(answered_.get());
    std::array<int, n> out;
    std::copy_n(answers_.data(), n, out.begin());
    return out;
  }

 protected:
  Launcher launcher_;
  std::unique_ptr<DeviceLink> link_;
  std::unique_ptr<EdgeStream> edges_;  ///< null: exchanges are in the order of the launches

 private:
  void make_room(std::size_t n) {
    if (values_.size() < n) values_.resize(n);
  }
  PinnedBuffer<int> values_, answers_;
  Event answered_;
};

}  // namespace pbf::PBF_VARIANT
