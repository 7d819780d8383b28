// The CPU executor of a rank: passes run for its own rows (rank_rows.h). Without other ranks it is
// the executor of a whole scene.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "lib/exec/cpu/cpu_exec.h"
#include "lib/exec/ranks/rank_rows.h"

namespace pbf::PBF_VARIANT {

class RankExec : public CpuExec {
 public:
  /// The rows for which passes run, and all rows. counted: their number may change.
  struct Rows {
    int first, last, all;
    bool counted;
  };
  /// ranks: null if there is one alone. The others as for CpuExec.
  explicit RankExec(Communicator* ranks, int threads, int list_entries = 37,
                    Simd simd = chosen_simd())
      : CpuExec(threads, list_entries, simd),
        ranks_(ranks),
        rows_(ranks ? std::make_unique<RankRows>(*ranks) : nullptr) {}

  Rows counted(const RowState* state, int launched) const {
    const int all = state ? int(state->rows) : launched;
    return ranks_ ? Rows{rows_->first(), rows_->last(), all, true}
                  : Rows{0, all, all, state != nullptr};
  }

  using CpuExec::build_lists, CpuExec::items, CpuExec::pairs, CpuExec::repeat_while;
  template <ItemPass Pass>
  void items(const Rows& rows, const Pass& pass) {
    in_pieces<1>(
        rows.last,
        [&](int first, int last) {
          for (int i = first; i < last; ++i) pass(i);
        },
        rows.first);
  }
  template <PairPass Pass>
  void pairs(const Rows& rows, const Pass& pass) {
    using Real = std::remove_cvref_t<decltype(pass.p.dt)>;
    const int width = 1 << lane_bits(simd(), sizeof(Real));
    in_pieces<1>(
        rows.last,
        [&](int first, int last) {
          // The lists of a group are read together, so the rows before the first whole group go
          // one by one. The bits are the same.
          const int whole = std::min((first + width - 1) / width * width, last);
          for (int i = first; i < whole; ++i) sum_over_neighbors(pass, i);
          sum_over_neighbors(simd(), pass, whole, last);
        },
        rows.first);
  }
  /// Rows near solids are listed with those of ghosts.
  template <ItemPass Pass>
  void listed(const int* count, int most, const Pass& pass) {
    if constexpr (requires { pass.row(0); })
      if (ranks_)
        return CpuExec::listed(count, most, OwnOf<Pass>{pass, rows_->first(), rows_->last()});
    CpuExec::listed(count, most, pass);
  }
  /// The bricks of the slab, and then the sums over all bricks.
  template <BrickPass Pass>
  void bricks(const Pass& pass) {
    if (!ranks_) return CpuExec::bricks(pass);
    const int row = pass.grid.bricks(0) * pass.grid.bricks(1), most = pass.grid.bricks();
    const int low = rows_->slabs().first_unit(ranks_->rank()),
              high = rows_->slabs().first_unit(ranks_->rank() + 1);
    in_pieces<16>(
        std::min(high * row, most),
        [&](int first, int last) {
          for (int n = first; n < last; ++n) of_brick(pass, n);
        },
        low * row);
    rows_->add_within();
  }

  template <ReducePass Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    if (!ranks_) return CpuExec::reduce(n, pass);
    MeasureCounts counts;
    Pass of_rows = pass;
    if constexpr (requires { pass.step_counts; }) {  // a rank has its own, whatever its rows
      counts = of_steps(*pass.step_counts);
      of_rows.step_counts = &kNoSteps;
    }
    const int first = rows_->first(), own = rows_->last() - first;
    counts.add(sum<MeasureCounts>(own, [&](int i) { return of_rows.counts(first + i); }));
    counts = over_ranks(counts);
    const MeasureUnits unit(counts);
    return {counts, over_ranks(sum<MeasureTerms>(
                        own, [&](int i) { return of_rows.terms(first + i, unit); }))};
  }
  template <class Pass>
  std::vector<std::int64_t> count_in_bins(int n, int bins, const Pass& pass) {
    if (!ranks_) return CpuExec::count_in_bins(n, bins, pass);
    std::vector<std::int64_t> all = CpuExec::count_in_bins(
        rows_->last() - rows_->first(), bins, [&](int i) { return pass(rows_->first() + i); });
    ranks_->sum(all);
    return all;
  }
  template <class Pass, class Body>
  void repeat_while(const char* stage, const Rows& rows, int times, const Pass& pass,
                    double tolerance, unsigned long long* repeats, const Body& body) {
    if (!ranks_)
      return CpuExec::repeat_while(stage, rows.all, times, pass, tolerance, repeats, body);
    const std::uint64_t limit = residual_limit(tolerance, rows_->particles());
    for (int k = 0; k < times; ++k) {
      Residual mine = sum<Residual>(rows.last - rows.first,
                                    [&](int i) { return Residual{pass(rows.first + i)}; });
      ranks_->sum({&mine.sum, 1});
      mark(stage);
      if (std::uint64_t(mine.sum) <= limit) return;
      if (ranks_->rank() == 0) ++*repeats;
      body();
    }
  }
  template <bool leave, class First, class Near, class Gather>
  void sort_by_bin(const char* stage, const First& of, const Near& near, int n, int bins,
                   const int* id, int* order, int* start, const Gather& gather) {
    CpuExec::sort_by_bin<leave>(stage, of, near, n, bins, id, order, start, gather);
  }
  template <bool leave, class First, class Near, class Gather>
  void sort_by_bin(const char* stage, const First& of, const Near& near, const Rows& rows, int bins,
                   const int* id, int* order, int* start, const Gather& gather) {
    if (rows.counted)
      CpuExec::sort_by_bin<leave>(stage, of, near, rows.all, bins, id, order, start, gather);
    else
      CpuExec::sort_by_bin<false>(stage, of, near, rows.all, bins, id, order, start, gather);
  }
  template <class Real>
  Lists build_lists(const Rows& rows, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p) {
    return CpuExec::build_lists(rows.last, far, position, bin_start, p, rows.first);
  }

  // What the solver calls on every rank; see RankRows.

  /// Null if there are no other ranks.
  RankRows* rows() { return rows_.get(); }
  template <class P, class C>
  bool before(C& c) {
    return !rows_ || rows_->before<P>(c);
  }
  template <class C>
  void after(C& c) {
    if (rows_) rows_->after(c);
  }
  template <class Sums>
  void add_up(std::vector<Sums>& sums) {
    if (rows_) rows_->add_up(sums);
  }

 private:
  static constexpr StepCounts kNoSteps{};

  template <class Pass>
  struct OwnOf {
    const Pass& pass;
    int first, last;
    void operator()(int k) const {
      if (const int i = pass.row(k); i >= first && i < last) pass(k);
    }
  };
  struct Residual {
    std::int64_t sum = 0;
    Residual() = default;
    explicit Residual(std::uint64_t one) : sum(std::int64_t(one)) {}
    void add(const Residual& o) { sum += o.sum; }
  };
  static MeasureCounts of_steps(const StepCounts& c) {
    MeasureCounts m;
    m.fast = std::int64_t(c.fast), m.repeats = std::int64_t(c.repeats);
    m.unresolved = std::int64_t(c.unresolved), m.way_squared = c.way_squared;
    return m;
  }
  template <class Sum>
  Sum over_ranks(const Sum& mine) {
    const std::vector<char> all = ranks_->all_gather(&mine, sizeof mine);
    Sum total;
    for (std::size_t at = 0; at < all.size(); at += sizeof(Sum)) {
      Sum one;
      std::memcpy(static_cast<void*>(&one), all.data() + at, sizeof one);
      total.add(one);
    }
    return total;
  }

  Communicator* ranks_;
  std::unique_ptr<RankRows> rows_;
};

}  // namespace pbf::PBF_VARIANT
