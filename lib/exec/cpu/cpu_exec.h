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
#include "lib/base/stage_clock.h"
#include "lib/exec/cpu/host_buffer.h"
#include "lib/exec/cpu/lane_sums.h"
#include "lib/exec/cpu/list_maker.h"
#include "lib/program/memory.h"
#include "lib/solver/executor.h"

namespace pbf::PBF_VARIANT {

class CpuExec {
 public:
  using Lists = ChunkedLists;
  static constexpr Backend backend = Backend::cpu;
  static constexpr bool lists_overflow = false;  ///< they grow as they are made
  template <class T>
  using Buffer = HostBuffer<T>;

  /// threads >= 1. list_entries: capacity per particle for its neighbors, at first
  /// (lib/program/memory.h); pages that stay empty are never touched.
  explicit CpuExec(int threads, int list_entries = 37, Simd simd = chosen_simd())
      : threads_(threads),
        list_entries_(list_entries),
        simd_(simd),
        scratch_(std::size_t(threads)) {}

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
  bool grow_lists(int) { return false; }

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

  /// The present number of particles, for launches.
  int counted(const RowState* state, int) const { return int(state->rows); }
  void rows_changed() {}

  // Passes by their shapes (kernels/pass_shapes.h). Here one thread computes a whole item.
  template <ItemPass Pass>
  void items(int n, const Pass& pass) {
    in_pieces<1>(n, [&](int first, int last) {
      for (int i = first; i < last; ++i) pass(i);
    });
  }
  template <PairPass Pass>
  void pairs(int n, const Pass& pass) {
    in_pieces<1>(n, [&](int first, int last) { sum_over_neighbors(simd_, pass, first, last); });
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
    in_pieces<kShare>(pass.grid.bricks(), [&](int first, int last) {
      for (int n = first; n < last; ++n) of_brick(pass, n);
    });
  }
  /// The items 0..*count-1; at most `most`.
  template <ItemPass Pass>
  void listed(const int* count, int, const Pass& pass) {
    items(*count, pass);
  }

  /// A measurement: maxima and counts, then the sums in units that follow from the maxima.
  template <ReducePass Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    const auto counts = sum<MeasureCounts>(n, [&](int i) { return pass.counts(i); });
    const MeasureUnits unit(counts);
    return {counts, sum<MeasureTerms>(n, [&](int i) { return pass.terms(i, unit); })};
  }

  /// Calls body() while the mean of pass(i) is above `tolerance`, at most `times` times, and counts
  /// the calls in *repeats. Marks `stage` after every sum.
  template <class Pass, class Body>
  void repeat_while(const char* stage, int n, int times, const Pass& pass, double tolerance,
                    unsigned long long* repeats, const Body& body) {
    const std::uint64_t limit = residual_limit(tolerance, n);
    for (int k = 0; k < times; ++k) {
      std::uint64_t sum = 0;
#pragma omp parallel for schedule(static) reduction(+ : sum) num_threads(threads_) if (n > 4096)
      for (int i = 0; i < n; ++i) sum += pass(i);
      mark(stage);
      if (sum <= limit) return;
      ++*repeats;
      body();
    }
  }

  /// The number of particles that pass(i) puts into each of `bins` bins; none if it is negative.
  template <class Pass>
  const std::vector<std::int64_t>& count_in_bins(int n, int bins, const Pass& pass) {
    in_bins_.assign(std::size_t(bins), 0);
#pragma omp parallel num_threads(threads_) if (n > kChunk)
    {
      std::vector<std::int64_t> mine(std::size_t(bins), 0);
#pragma omp for schedule(static) nowait
      for (int i = 0; i < n; ++i)
        if (const int b = pass(i); b >= 0) ++mine[std::size_t(b)];
#pragma omp critical(pbf_count_in_bins)
      for (std::size_t b = 0; b < mine.size(); ++b) in_bins_[b] += mine[b];
    }
    return in_bins_;
  }

  /// Calls first(i) for every particle, which writes first.bin[i] or leaves this to `near`; sorts
  /// by bin and, within a bin, by id (start[b] = first place of bin b, start[bins] = n); calls
  /// gather(from, to) for every particle. The order of rows therefore follows from the positions
  /// alone. Marks `stage` after `first`. leave: rows with a negative id leave; n is the number of
  /// all rows, start[bins] that of the others.
  template <bool leave, class First, class Listed, class Gather>
  void sort_by_bin(const char* stage, const First& first, const Listed& near, int n, int bins,
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
        if (id[i] < 0) first.bin[i] = bins;
    sort(first.bin, id, n, bins, order, start);
    items(leave ? start[bins] : n, [&](int k) { gather(order[k], k); });
  }
  /// order[k] = row of the k-th particle by (bin, id). Leaves out rows of bin `bins`.
  void sort(const int* bin, const int* id, int n, int bins, int* order, int* start);

  /// Lists of exactly the pairs of n particles closer than h. Memory grows as needed (throws
  /// std::bad_alloc). far: the row that pads lists. from: rows before it need no lists.
  template <class Real>
  Lists build_lists(int n, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p, int from = 0) {
    const int chunks = (n + kChunk - 1) / kChunk;
    const int bits = lane_bits(simd_, sizeof(Real)), groups_per_chunk = kChunk >> bits;
    chunks_.resize(std::size_t(chunks));
    pointers_.resize(std::size_t(chunks));
    groups_.resize(std::size_t(chunks) * std::size_t(groups_per_chunk));
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_) if (chunks > 1)
    for (int c = from / kChunk; c < chunks; ++c) {
      ListScratch& scratch = scratch_[std::size_t(omp_get_thread_num())];
      scratch.reserve(list_entries_);
      const int first = c * kChunk, last = std::min(n - first, kChunk) + first;
      ChunkedLists::Group* groups = groups_.data() + std::size_t(c) * std::size_t(groups_per_chunk);
      const std::size_t used =
          p.dimensions == 2
              ? make_lists<2>(simd_, position, bin_start, p, first, last, far, groups, scratch)
              : make_lists<3>(simd_, position, bin_start, p, first, last, far, groups, scratch);
      HostBuffer<int>& mine = chunks_[std::size_t(c)];
      // Grow with a reserve, shrink only if far too large: sizes change little between updates.
      const std::size_t capacity = std::size_t(std::min(kChunk, n - c * kChunk) * list_entries_);
      if (mine.size() < used || mine.size() > 2 * std::max(used, capacity))
        mine.resize(used > capacity ? used + used / 16 : capacity);
      std::copy_n(scratch.found.data(), used, mine.data());  // if used is 0, both may be null
      pointers_[std::size_t(c)] = mine.data();
    }
    return {pointers_.data(), groups_.data(), bits, far};
  }

  /// place[i]: how many of the n different numbers, none negative, are smaller than id[i].
  void rank(int n, const int* id, int* place);

  std::size_t bytes() const;

 protected:
  /// See LevelBrickPass.
  template <class Pass>
  static void of_brick(const Pass& pass, int n) {
    const auto brick = pass.brick(n);
    std::int64_t found[Pass::brick_cells];
    for (int k = 0; k < Pass::brick_cells; ++k) {
      const auto c = pass.cell(brick, k);
      found[k] = pass.grid.has(c) ? pass.finish(c, pass.part(c, 0, 1)) : 0;
    }
    for (int which = 0; which < Pass::brick_corners; ++which) {
      auto sum = pass.share(which, 0, found[0]);
      for (int k = 1; k < Pass::brick_cells; ++k)
        if (found[k] != 0) sum += pass.share(which, k, found[k]);
      pass.finish_corner(brick, which, sum);
    }
  }

  /// Calls f(first, last) for pieces of 0..n-1; an item is as much work as `share` particles.
  /// Dynamic scheduling: particles at the surface have fewer neighbors, and another program may
  /// occupy a core for a while. from: the first item, in the middle of a piece.
  template <int share, class F>
  void in_pieces(int n, const F& f, int from = 0) {
    constexpr int piece = kPiece / share;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_) if (n - from > kChunk / share)
    for (int first = from / piece * piece; first < n; first += piece)
      f(std::max(first, from), std::min(n - first, piece) + first);
  }
  template <class Pass>
  void wholes(int n, const Pass& pass) {
    in_pieces<kShare>(n, [&](int first, int last) {
      for (int i = first; i < last; ++i) pass.finish(i, pass.part(i, 0, 1));
    });
  }
  /// The sum of term(i), which does not depend on the order of terms.
  template <class Sum, class Term>
  Sum sum(int n, const Term& term) {
    Sum total;
#pragma omp parallel num_threads(threads_) if (n > kChunk)
    {
      Sum mine;
#pragma omp for schedule(static) nowait
      for (int i = 0; i < n; ++i) mine.add(term(i));
#pragma omp critical(pbf_sum)
      total.add(mine);
    }
    return total;
  }
  Simd simd() const { return simd_; }

 private:
  static constexpr int kChunk = 1 << ChunkedLists::chunk_bits;
  static constexpr int kShare = 16;   ///< work of an item that threads may share, in particles
  static constexpr int kPiece = 256;  ///< of a pass: whole groups of lists, a few microseconds
  int threads_, list_entries_;
  Simd simd_;
  StageClock clock_;
  std::vector<std::int64_t> in_bins_;
  std::vector<ListScratch> scratch_;  ///< per thread
  std::vector<HostBuffer<int>> chunks_;
  std::vector<const int*> pointers_;
  HostBuffer<ChunkedLists::Group> groups_;
};

}  // namespace pbf::PBF_VARIANT
