// The CUDA executor: one stream; a thread per particle, or several for a neighbor sum where there
// are few particles.
#pragma once

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <algorithm>
#include <cub/device/device_histogram.cuh>
#include <cub/device/device_scan.cuh>
#include <string>
#include <vector>

#include "lib/base/stage_clock.h"
#include "lib/exec/cuda/device_buffer.h"
#include "lib/exec/cuda/host_copy.cuh"
#include "lib/exec/cuda/kernels.cuh"
#include "lib/exec/cuda/recorded.cuh"
#include "lib/exec/cuda/reduce.cuh"
#include "lib/exec/cuda/repeat.cuh"
#include "lib/exec/cuda/shared_pass.cuh"
#include "lib/exec/cuda/sort_kernels.cuh"
#include "lib/solver/executor.h"

namespace pbf::inline PBF_VARIANT {

class CudaExec {
 public:
  using Lists = TransposedLists;
  static constexpr Backend backend = Backend::cuda;
  static constexpr bool lists_overflow = true;
  template <class T>
  using Buffer = DeviceBuffer<T>;

  /// capacity: of the lists at first. If a list is longer, the build records its length and writes
  /// nothing beyond the capacity; grow_lists() enlarges it. total: particles of the whole scene,
  /// from which the number of threads of a sum follows.
  CudaExec(ListCapacity capacity, std::int64_t total);
  ~CudaExec();
  CudaExec(const CudaExec&) = delete;
  CudaExec& operator=(const CudaExec&) = delete;

  void synchronize() { PBF_CUDA_CHECK(cudaStreamSynchronize(stream_)); }

  // Stage times of sampled updates, from events on the stream.
  void begin();
  void mark(const char* stage);
  void forget_stages() {}  // nothing is sampled before the first update
  /// Divides the `seconds` of all updates in proportion to the stages of the sampled ones, which
  /// take longer because they are not recorded.
  std::vector<StageTime> stages(double seconds) const;
  void describe(SolverInfo& info) const;

  template <class Out, class Write>
  void start_copy(const std::vector<CopyTarget>& to, const Write& write) {
    copy_.start<Out>(to, write, stream_);
  }
  void finish_copy(const std::vector<CopyTarget>& to) { copy_.finish(to); }

  /// Replays recorded updates. From time to time one update runs unrecorded and is timed stage by
  /// stage, as a sample for the others.
  template <class Updates>
  void repeat(int updates, Updates& u) {
    const int every = u.size() < 100000 ? 1024 : 64;
    int left = updates;
    if (since_profile_ <= 0) {
      profiling_ = true;
      u.step(1);
      book(every);
      profiling_ = false;
      since_profile_ = every;
      --left;
    }
    since_profile_ -= updates;
    recorded_.repeat(left, u, stream_);
  }
  void forget_recorded() { recorded_.drop(); }
  int largest_batch(int n) const { return n < 20000 ? 256 : n < 500000 ? 64 : 16; }
  bool grow_lists(int n);

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

  template <ItemPass Pass>
  void items(int n, const Pass& pass) {
    launch(item_kernel<Pass>, n, kBlock, 0, n, pass);
  }
  /// The number of threads determines the tree of a neighbor sum, so it follows from the particles
  /// of the whole scene, not from those here.
  template <PairPass Pass>
  void pairs(int n, const Pass& pass) {
    // In two dimensions a list has a third of the words, enough for half as many threads.
    constexpr bool space = Pass::D == 3;
    if (launch_lanes < 16, space ? kSixteenLanes : 0 > (n, pass)) return;
    if (launch_lanes < space ? 8 : 4, kEightLanes > (n, pass)) return;
    if (launch_lanes < space ? 4 : 2, kFourLanes > (n, pass)) return;
    if (launch_lanes < 2, space ? kTwoLanes : 0 > (n, pass)) return;
    launch(pair_kernel<Pass>, n, kBlock, 0, n, pass);
  }
  template <SharedPass Pass>
  void shared(int n, const Pass& pass) {
    launch(shared_kernel<Pass>, n * Pass::lanes, kBlock, 0, n, pass);
  }
  template <TeamPass Pass>
  void teams(const Pass& pass) {
    int blocks = 0;
    for (int g = 0; g < pass.groups(); ++g) blocks += team_blocks(pass, g);
    launch(team_kernel<Pass>, blocks * kTeam, kTeam, 0, pass);
  }
  template <BrickPass Pass>
  void bricks(const Pass& pass) {
    launch(brick_kernel<Pass>, pass.grid.bricks() * kBrickBlock<Pass>, kBrickBlock<Pass>, 0, pass);
  }
  /// See CpuExec. Their number is known on the device alone.
  template <ItemPass Pass>
  void listed(const int* count, int most, const Pass& pass) {
    launch(listed_kernel<Pass>, std::min(most, kBlock * kListedBlocks), kBlock, 0, count, pass);
  }

  /// See CpuExec. The maxima stay on the device for the sums, so the host waits once.
  template <ReducePass Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    if (n == 0) return {};
    measure_.make(n, stream_);
    const int threads = kBlock * reduce_blocks(n);
    launch(reduce_kernel<CountsOf<Pass>>, threads, kBlock, 0, n, CountsOf<Pass>{pass},
           measure_.counts());
    launch(reduce_kernel<TermsOf<Pass>>, threads, kBlock, 0, n,
           TermsOf<Pass>{pass, measure_.counts().total, {}}, measure_.terms());
    return measure_.result(stream_);
  }

  /// See CpuExec.
  template <class Pass>
  const std::vector<std::int64_t>& count_in_bins(int n, int bins, const Pass& pass) {
    in_bins_.resize(std::size_t(bins));
    in_bins_host_.resize(std::size_t(bins));
    PBF_CUDA_CHECK(cudaMemsetAsync(in_bins_.data(), 0, in_bins_.bytes(), stream_));
    const auto bin = thrust::make_transform_iterator(thrust::counting_iterator<int>(0), pass);
    if (n > 0)
      with_scratch(in_bins_scratch_, [&](void* scratch, std::size_t& bytes) {
        return cub::DeviceHistogram::HistogramEven(scratch, bytes, bin, in_bins_.data(), bins + 1,
                                                   0, bins, n, stream_);
      });
    PBF_CUDA_CHECK(cudaMemcpyAsync(in_bins_host_.data(), in_bins_.data(), in_bins_.bytes(),
                                   cudaMemcpyDeviceToHost, stream_));
    synchronize();
    counted_.assign(in_bins_host_.data(), in_bins_host_.data() + bins);
    return counted_;
  }

  /// See CpuExec. If a graph is captured, the body becomes part of it, and the device repeats it
  /// without the host; otherwise the host waits for every sum.
  template <class Pass, class Body>
  void repeat_while(const char* stage, int n, int times, const Pass& pass, std::uint64_t limit,
                    unsigned long long* repeats, const Body& body) {
    if (repeat_.size() == 0) {
      repeat_.resize(1);
      PBF_CUDA_CHECK(cudaMemsetAsync(repeat_.data(), 0, repeat_.bytes(), stream_));
    }
    Repetition r{repeat_.data(), repeats, limit, unsigned(times), true, false, {}};
    const auto decide = [&] {
      launch(repeat_kernel<Pass>, std::min(n, kBlock * kRepeatBlocks), kBlock, 0, n, pass, r);
      mark(stage);
      r.first = false;
    };
    r.in_graph = new_condition(r.handle);
    decide();
    if (r.in_graph) {
      begin_repeated(r.handle);
      body();
      decide();
      end_repeated();
    } else {
      for (; asked_to_repeat(); decide()) body();
    }
  }

  /// See CpuExec; `order` holds the order of arrival within bins.
  template <class First, class Listed, class Gather>
  void sort_by_bin(const char* stage, const First& first, const Listed& near, int n, int bins,
                   const int* id, int* order, int* start, const Gather& gather) {
    constexpr bool leaves_rows = requires { near.pass; };
    slot_.resize(std::size_t(n));
    const OrderPass<Gather> in_order{first.bin, id, start, slot_.data(), gather};
    if (n <= kSortParticles && bins <= kSortBins) {
      const auto sort = [&](const auto& before) {
        launch(small_sort_kernel<std::decay_t<decltype(before)>, Gather>, kSortThreads,
               kSortThreads, std::size_t(bins) * sizeof(int), before, n, bins, order, slot_.data(),
               start, list_state_.data(), in_order);
      };
      if constexpr (leaves_rows || PairPass<First>) {
        items_or_pairs(n, first);
        if constexpr (leaves_rows) {
          if (near.count) listed(near.count, n, near.pass);
        }
        mark(stage);
        sort(NothingFirst{});
      } else {
        sort(first);
      }
      return;
    }
    if (counts_.size() != std::size_t(bins) + 1) {
      counts_.resize(std::size_t(bins) + 1);
      PBF_CUDA_CHECK(cudaMemsetAsync(counts_.data(), 0, counts_.bytes(), stream_));
    }
    items_or_pairs(n, CountPass<First>{first, counts_.data(), order});
    if constexpr (leaves_rows) {
      using Near = std::decay_t<decltype(near.pass)>;
      if (near.count) listed(near.count, n, CountPass<Near>{near.pass, counts_.data(), order});
    }
    mark(stage);
    scan(bins + 1, start);
    items(n, PlacePass{first.bin, start, order, slot_.data(), counts_.data(), list_state_.data(), n,
                       bins + 1});
    items(n, in_order);
  }

  template <class Real>
  Lists build_lists(int n, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p) {
    allocate_lists(n);
    p.dimensions == 2 ? make_lists<2>(n, far, position, bin_start, p)
                      : make_lists<3>(n, far, position, bin_start, p);
    return {words_.data(),  overflows_.data(), count_.data(),      overflow_of_.data(),
            list_stride(n), capacity_.first,   capacity_.overflow, far};
  }

  std::size_t bytes() const {
    return words_.bytes() + overflows_.bytes() + overflow_of_.bytes() + count_.bytes() +
           counts_.bytes() + slot_.bytes() + scan_.bytes() + measure_.bytes() + in_bins_.bytes() +
           in_bins_scratch_.bytes() + repeat_.bytes() + copy_.bytes();
  }

 private:
  template <class Pass>
  void items_or_pairs(int n, const Pass& pass) {
    if constexpr (PairPass<Pass>)
      pairs(n, pass);
    else
      items(n, pass);
  }
  /// Runs a device-wide algorithm of CUB: call(scratch, bytes) returns the bytes that it needs if
  /// `scratch` is null, and runs otherwise.
  template <class Call>
  static void with_scratch(DeviceBuffer<char>& scratch, const Call& call) {
    std::size_t bytes = 0;
    PBF_CUDA_CHECK(call(nullptr, bytes));
    if (scratch.size() < bytes) scratch.resize(bytes);
    PBF_CUDA_CHECK(call(scratch.data(), bytes));
  }
  /// Enough blocks of `block` threads for `threads`.
  template <class... P, class... A>
  void launch(void (*kernel)(P...), int threads, int block, std::size_t shared, const A&... args) {
    if (threads == 0) return;
    start_kernel(stream_, overlap_ && !after_condition_, kernel, threads, block, shared, args...);
    after_condition_ = false;
  }
  /// Launches `lanes` threads per particle if the scene has at most `most`; returns whether it did.
  template <int lanes, int most, class Pass>
  bool launch_lanes(int n, const Pass& pass) {
    if constexpr (most > 0) {
      if (total_ <= most) {
        launch(lanes_kernel<lanes, Pass>, lanes * n, kBlock, 0, n, pass);
        return true;
      }
    }
    return false;
  }
  template <int D, class Real>
  void make_lists(int n, int far, const Vec4<Real>* position, const int* bin_start,
                  const Params<Real>& p) {
    const ListPass<Real, D> pass{p,
                                 position,
                                 bin_start,
                                 words_.data(),
                                 overflows_.data(),
                                 count_.data(),
                                 overflow_of_.data(),
                                 list_state_.data(),
                                 capacity_,
                                 list_stride(n),
                                 n,
                                 far};
    if (n <= kListLanes)
      launch(list_lanes_kernel<Real, D>, pass.lanes * n, kBlock, 0, pass);
    else
      items(n, pass);
  }
  void allocate_lists(int n);
  void clear_overflow();
  /// Waits for the marks since begin() and books their times, multiplied by `scale`.
  void book(double scale);
  /// Makes a condition in the graph that is being captured; false if none is.
  bool new_condition(cudaGraphConditionalHandle& handle);
  /// Launches between these two are captured as the body that the condition repeats.
  void begin_repeated(cudaGraphConditionalHandle handle);
  void end_repeated();
  bool asked_to_repeat();
  /// Exclusive sums of the counts.
  void scan(int n, int* start);

  std::string device_, driver_;  ///< names
  cudaStream_t stream_ = nullptr;
  cudaStream_t other_stream_ = nullptr;  ///< while a repeated body is captured: that of the graph
  bool overlap_ = false;                 ///< the device has programmatic dependent launch
  bool after_condition_ = false;         ///< ... which works only from kernel to kernel
  ListCapacity capacity_;
  std::int64_t total_;
  bool profiling_ = false;
  int since_profile_ = 0;
  RecordedUpdates recorded_;
  HostCopy copy_;
  StageClock clock_;
  std::vector<cudaEvent_t> events_;
  std::vector<const char*> stages_;  ///< of the marks since begin()
  MeasureSpace measure_;
  DeviceBuffer<unsigned long long> in_bins_;
  DeviceBuffer<char> in_bins_scratch_;
  PinnedBuffer<unsigned long long> in_bins_host_;
  std::vector<std::int64_t> counted_;
  DeviceBuffer<int4> words_, overflows_;
  DeviceBuffer<int> count_, overflow_of_, counts_, slot_;
  DeviceBuffer<ListState> list_state_;
  PinnedBuffer<ListState> list_state_host_;
  DeviceBuffer<char> scan_;  ///< separate, because recorded updates hold its address
  DeviceBuffer<RepeatState> repeat_;
};

}  // namespace pbf::inline PBF_VARIANT
