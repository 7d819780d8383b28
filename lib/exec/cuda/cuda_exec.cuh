// The CUDA executor: one stream; for few particles all iterations in one kernel.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "lib/base/stage_clock.h"
#include "lib/exec/cuda/counting_sort.cuh"
#include "lib/exec/cuda/cuda_passes.cuh"
#include "lib/exec/cuda/device_lists.cuh"
#include "lib/exec/cuda/host_copy.cuh"
#include "lib/exec/cuda/recorded.cuh"
#include "lib/exec/cuda/repeat.cuh"
#include "lib/exec/cuda/turns.cuh"
#include "lib/solver/executor.h"

namespace pbf::PBF_VARIANT {

class CudaExec : public CudaPasses {
 public:
  using Lists = TransposedLists;
  using UnknownRows = RowsBetween;  ///< of ranks: rows whose numbers the host does not know yet
  static constexpr Backend backend = Backend::cuda;
  static constexpr bool lists_overflow = true;
  static constexpr bool counts_on_device = true;  ///< the number of rows, where it changes
  template <class T>
  using Buffer = DeviceBuffer<T>;

  /// capacity: of the lists at first; grow_lists() enlarges it. total: most particles of the whole
  /// scene, from which the number of threads of a sum follows. rows: most rows here.
  CudaExec(ListCapacity capacity, std::int64_t total, std::int64_t rows);
  ~CudaExec();
  CudaExec(const CudaExec&) = delete;

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
    copy_.start<Out>(to, write, launcher_);
  }
  void finish_copy(const std::vector<CopyTarget>& to) {
    before_waiting();
    copy_.finish(to);
  }

  /// Replays recorded updates. From time to time one update runs unrecorded and is timed stage by
  /// stage, as a sample for the others.
  template <class Updates>
  void repeat(int updates, Updates& u) {
    const int every = u.capacity() < 100000 ? 1024 : 64;
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
    recorded_.repeat(left, u, [this] { return launcher_.ready(); });
  }
  void forget_recorded() { recorded_.drop(); }
  int largest_batch(int n) const { return n < 20000 ? 256 : n < 500000 ? 64 : 16; }
  bool grow_lists(int n) {
    list_demand();
    return grow_lists(n, {});
  }
  // The same in parts, of which the first waits for the device: see DeviceLists.
  ListDemand list_demand();
  bool grow_lists(int n, const ListDemand& elsewhere);
  /// After grow_lists() was false: more memory for lists that are nearly too long, so that updates
  /// to come need not be repeated. Present lists are lost.
  void enlarge_lists(int n);

  static int rows_now(const RowState&) {
    throw Error(ExitCode::internal, "the number of rows is on the device");
  }
  /// The next kernel starts after the last one has ended, so it sees the new number.
  void rows_changed() { launcher_.alone = true; }

  /// See CpuExec. If a graph is captured, the body becomes part of it, and the device repeats it
  /// without the host; otherwise the host waits for every sum.
  template <class Rows, class Pass, class Body>
  void repeat_while(const char* stage, const Rows& n, int times, const Pass& pass, double tolerance,
                    unsigned long long* repeats, const Body& body) {
    if (repeat_.size() == 0) {
      repeat_.resize(1);
      PBF_CUDA_CHECK(cudaMemsetAsync(repeat_.data(), 0, repeat_.bytes(), launcher_.ready()));
    }
    Repetition r{repeat_.data(), repeats, tolerance, unsigned(times), true, false, {}};
    const auto decide = [&] {
      launch(repeat_kernel<Rows, Pass>, std::min(most(n), kBlock * kRepeatBlocks), kBlock, 0, n,
             pass, r);
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

  /// See CpuExec; `order` holds the order of arrival within bins. If `first` runs in a kernel with
  /// other passes, first.launch(arrivals) launches it, and its rows are counted unless that is
  /// empty.
  template <bool leave, class Rows, class First, class Listed, class Gather>
  const int* sort_by_bin(const char* stage, const First& first, const Listed& near, const Rows& n,
                         int bins, const int* id, int* order, int* start, const Gather& gather) {
    constexpr bool leaves_rows = requires { near.pass; };
    constexpr bool launches = requires { first.launch; };
    const BinSort sort{{0, bins}, bins, id, order, start};
    const auto all = int(rows_);
    if (all <= kSortParticles && bins <= kSortBins) {
      const auto small = [&](const auto& before) {
        sort_.small<leave>(launcher_, sort, rows_, n, before, lists_.state(), gather);
      };
      if constexpr (launches) {
        first.launch({});
        small(KnownBinPass{first.bin});
      } else if constexpr (leaves_rows || PairPass<First>) {
        items_or_pairs(n, first);
        if constexpr (leaves_rows) {
          if (near.count) listed(near.count, all, near.pass);
        }
        mark(stage);
        small(KnownBinPass{first.bin});
      } else {
        small(first);
      }
      return start + bins;
    }
    begin_sort(sort);
    if constexpr (launches)
      first.launch(sort_.arrivals<leave>(sort));
    else
      items_or_pairs(n, counting<leave>(sort, first));
    if constexpr (leaves_rows) {
      if (near.count) listed(near.count, all, counting<leave>(sort, near.pass));
    }
    mark(stage);
    sort_counted<leave>(sort, first.bin, n, gather);
    return start + bins;
  }
  void begin_sort(const BinSort& s) { sort_.begin(s, rows_, launcher_); }
  template <bool leave = true, class Pass>
  CountPass<leave, Pass> counting(const BinSort& s, const Pass& pass) {
    return sort_.counting<leave>(s, pass);
  }
  template <bool leave = true, class Rows, class Gather>
  void sort_counted(const BinSort& s, const int* bin, const Rows& n, const Gather& gather) {
    sort_.place(launcher_, s, bin, n, lists_.state());
    items(n, sort_.in_order<leave>(s, bin, gather));
  }

  template <class Rows, class Real>
  Lists build_lists(const Rows& n, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p) {
    if constexpr (std::is_same_v<Rows, RowsBetween>) launcher_.alone = true;
    return lists_.make(launcher_, n, far, position, bin_start, p);
  }

  /// Whether run_beside() may be used: not if an update is timed by stages, as the first one is, in
  /// which the second stream is made, before a graph is recorded.
  bool has_beside() {
    if (!aside_) aside_ = std::make_unique<EdgeStream>();
    return !profiling_;
  }
  /// Launches small() on a stream of its own beside large(). What follows needs both, but for what
  /// meanwhile() launches next, which needs large() alone.
  void run_beside(const auto& small, const auto& large) { aside_->ahead(launcher_, small, large); }
  void meanwhile(const auto& launches) { launcher_.meanwhile(launches); }

#ifndef PBF_PINNED
  static constexpr bool packed_rows = true;  ///< has passes of packed rows
  using TurnLists = ChangingLists;           ///< for passes of turns() and turn()
  Lists prepare_lists(int far) { return lists_.prepare(far); }  ///< those that turns() makes
  /// Whether turns() can run these passes in one launch. Not if an update is timed by stages.
  template <class Lambda, class Delta, class Xsph>
  bool has_turns(const RowRange& rows, const Lambda&, const Delta&, const Xsph&) {
    return !profiling_ && turns_.fits<Lambda, Delta, Xsph>(total_, rows);
  }
  /// Lists if bin_start is not null, lambda and delta once for each of `factors` (omega), and XSPH
  /// if it has an array for its results. arrivals: see Turns.
  template <class Lambda, class Delta, class Xsph>
  void turns(const RowRange& rows, const int* bin_start, std::span<const float> factors,
             const Lambda& lambda, const Delta& delta, const Xsph& xsph,
             const Arrivals<false>& arrivals) {
    const bool lists = bin_start != nullptr, sweeps = xsph.velocity_out.rows() != nullptr;
    Turns<Lambda, Delta, Xsph> t{{lists, true, true, sweeps}, {}, lambda, delta, xsph, arrivals};
    if (lists)
      t.lists =
          lists_.pass<3, false>(lambda.lists.far, lambda.position.rows(), bin_start, lambda.p);
    t.times = int(factors.size());
    std::copy(factors.begin(), factors.end(), t.factor);
    turns_.all(launcher_, total_, rows, t);
  }
  /// Lambda, or else delta, alone, with the same bits.
  template <class Lambda, class Delta, class Xsph>
  void turn(const RowRange& rows, bool is_lambda, const Lambda& lambda, const Delta& delta,
            const Xsph& none) {
    Turns<Lambda, Delta, Xsph> t{{false, is_lambda, !is_lambda, false}, {}, lambda, delta, none};
    t.times = 1;
    t.factor[0] = delta.p.sor;
    turns_.one(launcher_, total_, rows, t);
  }
#endif

  void rank(int n, const int* id, int* place);  ///< see CpuExec

  void connect(Communicator& ranks);
  void add_one(unsigned long long* count);
  /// repeat() without graphs: the host takes part in every update.
  template <class Updates>
  void repeat_unrecorded(int updates, Updates& u) {
    while (updates > 0) {
      const int plain = std::min(updates, since_profile_);
      if (plain > 0)
        u.step(plain);
      else
        sample(u);
      updates -= std::max(plain, 1);
      since_profile_ = plain > 0 ? since_profile_ - plain : kSampleEvery - 1;
    }
  }

  std::size_t bytes() const {
    return lists_.bytes() + sort_.bytes() + repeat_.bytes() + copy_.bytes() + CudaPasses::bytes();
  }

 private:
  static constexpr int kSampleEvery = 64;  ///< updates of several ranks
  /// In turns an update for stage times, in which exchanges are not beside passes, and one for the
  /// time that exchanges take beside passes.
  template <class Updates>
  void sample(Updates& u) {
    if (edges_ && samples_++ % 2 == 1)
      return edges_->watch([&] { u.step(1); }, [&] { synchronize(); });
    auto edges = std::move(edges_);
    ++stage_samples_;
    profiling_ = true;
    u.step(1);
    book(kSampleEvery);
    profiling_ = false;
    edges_ = std::move(edges);
  }
  /// The share of the stage exchange that runs beside other stages.
  double hidden_exchange() const;
  /// Waits for the marks since begin() and books their times, multiplied by `scale`.
  void book(double scale);
  /// Makes a condition in the graph that is being captured; false if none is.
  bool new_condition(cudaGraphConditionalHandle& handle);
  /// Launches between these two are captured as the body that the condition repeats.
  void begin_repeated(cudaGraphConditionalHandle handle);
  void end_repeated();
  bool asked_to_repeat();

  std::string device_, driver_;          ///< names
  cudaStream_t other_stream_ = nullptr;  ///< while a repeated body is captured: that of the graph
  DeviceLists lists_;
  bool profiling_ = false;
  int since_profile_ = 0;
  RecordedUpdates recorded_;
  HostCopy copy_;
  StageClock clock_;
  int samples_ = 0, stage_samples_ = 0;
  std::vector<cudaEvent_t> events_;
  std::vector<const char*> stages_;  ///< of the marks since begin()
  CountingSort sort_;
  DeviceBuffer<RepeatState> repeat_;
  TurnLauncher turns_;
  std::unique_ptr<EdgeStream> aside_;  ///< of run_beside()
};

}  // namespace pbf::PBF_VARIANT
