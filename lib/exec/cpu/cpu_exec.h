// The CPU executor: OpenMP threads over particles. One thread is the sequential baseline; the
// result does not depend on the number of threads (every particle's sums have one order, the sort
// is stable, reductions are of integers).
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "kernels/measure.h"
#include "kernels/neighbors.h"
#include "kernels/pass_residual.h"
#include "kernels/pass_sort.h"
#include "lib/base/stage_clock.h"
#include "lib/exec/cpu/cpu_lists.h"
#include "lib/exec/cpu/cpu_rows.h"
#include "lib/exec/cpu/lane_sums.h"
#include "lib/program/list_capacity.h"
#include "lib/program/memory.h"
#include "lib/solver/executor.h"

namespace pbf::PBF_VARIANT {

class CpuExec : public CpuRows, protected CpuLists {
 public:
  using CpuLists::build_lists;
  using CpuThreads::count_in_bins, CpuThreads::sum_of;
  using Lists = ChunkedLists;
  static constexpr Backend backend = Backend::cpu;
  static constexpr bool lists_overflow = false;  ///< they grow as they are made
  template <class T>
  using Buffer = HostBuffer<T>;

  /// threads >= 1. list_entries: capacity per particle for its neighbors, at first
  /// (lib/program/memory.h); pages that stay empty are never touched.
  explicit CpuExec(int threads, int list_entries = 37, Simd simd = chosen_simd())
      : CpuLists(threads, list_entries, simd) {}

  void begin() { clock_.begin(); }
  void mark(const char* stage) { clock_.mark(stage); }
  void forget_stages() { clock_ = {}; }
  std::vector<StageTime> stages(double) const { return clock_.entries(); }
  void describe(SolverInfo& info) const;

  /// A download: write(pointers) writes directly to the arrays on the host.
  template <class Out, class Write>
  void start_copy(const std::vector<CopyTarget>& to, const Write& write) {
    std::vector<Out*> rows;
    for (const CopyTarget& t : to) rows.push_back(static_cast<Out*>(t.host));
    write(rows);
  }
  void finish_copy(const std::vector<CopyTarget>&) {}

  template <class Updates>
  void repeat(int updates, Updates& u) {
    u.step(updates);
  }
  void forget_recorded() {}
  int largest_batch(int) const { return 1 << 30; }
  static ListDemand list_demand() { return {}; }
  bool grow_lists(int, const ListDemand& = {}) { return false; }
  void enlarge_lists(int) {}

  /// Copies n elements to an array of this executor.
  template <class T>
  void to_device(const T* host, std::size_t n, T* to) {
    if (n) std::memcpy(to, host, n * sizeof(T));
  }

  /// Copies n elements of an array of this executor.
  template <class T>
  void to_host(const T* from, std::size_t n, T* host) {
    if (n) std::memcpy(host, from, n * sizeof(T));
  }

  /// The present number of particles, for launches. state: null if it is `launched`.
  int counted(const RowState* state, int launched) const {
    return state ? int(state->rows) : launched;
  }
  static int rows_now(const RowState& state) { return int(state.rows); }
  void rows_changed() {}

  // Passes by their shapes (kernels/pass_shapes.h). Here one thread computes a whole item.
  template <ItemPass Pass>
  void items(int n, const Pass& pass) {
    in_pieces<1>(n, [&](int first, int last) {
      for (int i = first; i < last; ++i) pass(i);
    });
  }
  template <ItemPass Pass>
  void items(const RowRange& rows, const Pass& pass) {
    in_pieces<1>(
        rows.last,
        [&](int first, int last) {
          each_run(rows, first, last, [&](int begin, int end) {
            for (int i = begin; i < end; ++i) pass(i);
          });
        },
        rows.first);
  }
  template <PairPass Pass>
  void pairs(int n, const Pass& pass) {
    pairs(RowRange{0, n}, pass);
  }
  template <PairPass Pass>
  void pairs(const RowRange& rows, const Pass& pass) {
    using Real = std::remove_cvref_t<decltype(pass.p.dt)>;
    const int width = 1 << lane_bits(simd(), sizeof(Real));
    in_pieces<1>(
        rows.last,
        [&](int begin, int end) {
          each_run(rows, begin, end, [&](int first, int last) {
            // The lists of a group are read together, so the rows before the first whole group go
            // one by one. The bits are the same.
            const int whole = std::min((first + width - 1) / width * width, last);
            for (int i = first; i < whole; ++i) sum_over_neighbors(pass, i);
            sum_over_neighbors(simd(), pass, whole, last);
          });
        },
        rows.first);
  }
  template <SharedPass Pass>
  void shared(int n, const Pass& pass) {
    wholes(n, pass);
  }
  template <TeamPass Pass>
  void teams(const Pass& pass) {
    wholes(pass.items(), pass);
  }
  template <BrickPass Pass>
  void bricks(const Pass& pass) {
    bricks(pass, 0, pass.grid.bricks());
  }
  /// The bricks begin ... end - 1.
  template <BrickPass Pass>
  void bricks(const Pass& pass, int begin, int end) {
    in_pieces<kShare>(
        end,
        [&](int first, int last) {
          for (int n = first; n < last; ++n) of_brick(pass, n);
        },
        begin);
  }
  /// The items 0..*count-1; at most `most`.
  template <ItemPass Pass>
  void listed(const int* count, int, const Pass& pass) {
    items(*count, pass);
  }

  /// A measurement: maxima and counts, then the sums in units that follow from the maxima.
  template <ReducePass Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    return reduce(n, pass, [](auto&) {});
  }
  /// join(sums): adds those of other ranks.
  template <ReducePass Pass, class Join>
  MeasureSums reduce(int n, const Pass& pass, const Join& join) {
    auto counts = sum<MeasureCounts>(n, [&](int i) { return pass.counts(i); });
    join(counts);
    const MeasureUnits unit(counts);
    auto terms = sum<MeasureTerms>(n, [&](int i) { return pass.terms(i, unit); });
    join(terms);
    return {counts, terms};
  }

  /// Calls body() while the mean of pass(i) is above `tolerance`, at most `times` times, and counts
  /// the calls in *repeats. Marks `stage` after every sum.
  template <class Pass, class Body>
  void repeat_while(const char* stage, int n, int times, const Pass& pass, double tolerance,
                    unsigned long long* repeats, const Body& body) {
    const std::uint64_t limit = residual_limit(tolerance, n);
    for (int k = 0; k < times; ++k) {
      const std::uint64_t sum = sum_of(n, pass);
      mark(stage);
      if (sum <= limit) return;
      add_one(repeats);
      body();
    }
  }
  void add_one(unsigned long long* count) { ++*count; }

  /// Calls first(i) for every particle, which writes first.bin[i] or leaves this to `near`; sorts
  /// by bin and, within a bin, by id (start[b] = first place of bin b, start[bins] = n); calls
  /// gather(from, to) for every particle. The order of rows therefore follows from the positions
  /// alone. Marks `stage` after `first`. leave: rows with a negative id leave; n is the number of
  /// all rows, start[bins] that of the others. Returns where that is.
  template <bool leave, class First, class Listed, class Gather>
  const int* sort_by_bin(const char* stage, const First& first, const Listed& near, int n, int bins,
                         const int* id, int* order, int* start, const Gather& gather) {
    if constexpr (PairPass<First>)
      pairs(n, first);
    else
      items(n, first);
    if constexpr (requires { near.pass; }) {
      if (near.count) listed(near.count, n, near.pass);
    }
    mark(stage);
    if constexpr (leave)
      for (int i = 0; i < n; ++i)
        if (id[i] < 0) first.bin[i] = -1;
    sort_counted({{0, bins}, bins, id, order, start}, first.bin, n, gather);
    return start + bins;
  }
  // The same in parts, for rows that come from other ranks between: begin_sort(), then passes that
  // give rows their bins, each as counting(sort, pass), and sort_counted() for n rows.
  void begin_sort(const BinSort&) {}
  template <class Pass>
  Pass counting(const BinSort&, const Pass& pass) {
    return pass;
  }
  template <class Gather>
  void sort_counted(const BinSort& s, const int* bin, int n, const Gather& gather) {
    sort(bin, s.id, n, s.bins, s.order, s.start);
    items(s.start[s.bins.end], [&](int k) { gather(s.order[k], k); });
  }
  /// order[k] = row of the k-th particle by (bin, id). Leaves out rows of other bins.
  void sort(const int* bin, const int* id, int n, const BinRange& bins, int* order, int* start);

  template <class Updates>
  void repeat_unrecorded(int updates, Updates& u) {
    u.step(updates);
  }

  /// place[i]: how many of the n different numbers, none negative, are smaller than id[i].
  void rank(int n, const int* id, int* place);

  std::size_t bytes() const;

 private:
  StageClock clock_;
};

}  // namespace pbf::PBF_VARIANT
