// The executor of a rank: passes run for its own rows (rank_rows.h). Without other ranks it is the
// executor of a whole scene. Base: the executor of the backend.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "lib/exec/ranks/rank_rows.h"
#include "lib/program/features.h"

namespace pbf::PBF_VARIANT {

template <class Base>
class RankExec : public Base {
 public:
  using typename Base::Lists;
  /// The rows for which passes run, and all rows. counted: their number may change. state: as in
  /// RowRange.
  struct Rows {
    int first, last, all;
    bool counted;
    const RowState* state = nullptr;
    operator RowRange() const { return {first, last, nullptr, state}; }
  };
  /// ranks: null if there is one alone. The others as for Base.
  template <class... Args>
  explicit RankExec(Communicator* ranks, Args&&... of_base)
      : Base(std::forward<Args>(of_base)...),
        ranks_(ranks),
        rows_(ranks ? std::make_unique<RankRows<Base>>(*ranks) : nullptr) {
    if (ranks) this->connect(*ranks);
  }

  /// launched: the rows, if their number does not change.
  Rows counted(const RowState* state, int launched) const {
    if (rows_) return {rows_->first(), rows_->last(), rows_->all(), true};
    if constexpr (kDeviceCounts) {
      return {0, launched, launched, state != nullptr, state};
    } else {
      const int all = state ? Base::rows_now(*state) : launched;
      return {0, all, all, state != nullptr};
    }
  }

  using Base::items, Base::pairs, Base::repeat_while, Base::build_lists;
  template <ItemPass Pass>
  void items(const Rows& rows, const Pass& pass) {
    over(rows, [&](const RowRange& r) { Base::items(r, pass); });
  }
  template <PairPass Pass>
  void pairs(const Rows& rows, const Pass& pass) {
    over(rows, [&](const RowRange& r) { Base::pairs(r, pass); });
  }
  /// Rows near solids are listed with those of ghosts. Without ranks all are own: one form of such
  /// a pass, since a compiler takes long for it.
  template <ItemPass Pass>
  void listed(const int* count, int most, const Pass& pass) {
    if constexpr (requires { pass.row(0); }) {
      const auto of = [&](const RowRange& r) { Base::listed(count, most, OwnOf<Pass>{pass, r}); };
      rows_ ? over({rows_->first(), rows_->last()}, of) : of({0, most});
    } else {
      Base::listed(count, most, pass);
    }
  }
  template <ItemPass Pass>
  void all_listed(const int* count, int most, const Pass& pass) {
    Base::listed(count, most, pass);
  }
  /// The bricks of the slab, and then the sums over all bricks.
  template <BrickPass Pass>
  void bricks(const Pass& pass) {
    if (!rows_) return Base::bricks(pass);
    const int row = pass.grid.bricks(0) * pass.grid.bricks(1), most = pass.grid.bricks();
    const int low = rows_->slabs().first_unit(ranks_->rank()),
              high = rows_->slabs().first_unit(ranks_->rank() + 1);
    Base::bricks(pass, low * row, std::min(high * row, most));
    rows_->add_within();
  }

  template <ReducePass Pass>
  MeasureSums reduce(int n, const Pass& pass) {
    if (!rows_) return Base::reduce(n, From<Pass>{pass, 0});
    MeasureCounts steps;
    Pass of_rows = pass;
    if constexpr (requires { pass.step_counts; }) {  // a rank has its own, whatever its rows
      StepCounts mine;
      this->to_host(pass.step_counts, 1, &mine);
      steps = counts_of(mine);
      of_rows.step_counts = no_steps();
    }
    const int first = rows_->first(), own = rows_->last() - first;
    return Base::reduce(own, From<Pass>{of_rows, first}, [&](auto& sums) {
      if constexpr (requires { sums.add(steps); }) sums.add(steps);
      sums = over_ranks(sums);
    });
  }
  template <class Pass>
  std::vector<std::int64_t> count_in_bins(int n, int bins, const Pass& pass) {
    if (!rows_) return Base::count_in_bins(n, bins, pass);
    std::vector<std::int64_t> all = own_in_bins(bins, pass);
    ranks_->sum(all);
    return all;
  }
  template <class Pass>
  std::vector<std::int64_t> own_in_bins(int bins, const Pass& pass) {
    return Base::count_in_bins(rows_->last() - rows_->first(), bins,
                               From<Pass>{pass, rows_->first()});
  }
  template <class Pass, class Body>
  void repeat_while(const char* stage, const Rows& rows, int times, const Pass& pass,
                    double tolerance, unsigned long long* repeats, const Body& body) {
    if constexpr (kDeviceCounts)
      if (rows.state)
        return Base::repeat_while(stage, RowRange(rows), times, pass, tolerance, repeats, body);
    if (!rows_) return Base::repeat_while(stage, rows.all, times, pass, tolerance, repeats, body);
    const auto sum = [&] {
      auto s = std::int64_t(Base::sum_of(rows.last - rows.first, From<Pass>{pass, rows.first}));
      ranks_->sum({&s, 1});
      return std::uint64_t(s);
    };
    repeat_from_host(stage, times, residual_limit(tolerance, rows_->particles()), repeats, sum,
                     body);
  }
  template <bool leave, class First, class Near, class Gather>
  const int* sort_by_bin(const char* stage, const First& of, const Near& near, int n, int bins,
                         const int* id, int* order, int* start, const Gather& gather) {
    return Base::template sort_by_bin<leave>(stage, of, near, n, bins, id, order, start, gather);
  }
  template <bool leave, class First, class Near, class Gather>
  const int* sort_by_bin(const char* stage, const First& of, const Near& near, const Rows& rows,
                         int bins, const int* id, int* order, int* start, const Gather& gather) {
    const int n = rows.all;
    if (rows_) return sort_on_ranks(stage, of, near, rows, bins, id, order, start, gather);
    if constexpr (kDeviceCounts) {
      if (rows.counted)
        return Base::template sort_by_bin<leave>(
            stage, of, near, RowRange{0, n, nullptr, rows.state}, bins, id, order, start, gather);
    } else if (rows.counted) {
      return Base::template sort_by_bin<leave>(stage, of, near, n, bins, id, order, start, gather);
    }
    return Base::template sort_by_bin<false>(stage, of, near, n, bins, id, order, start, gather);
  }
  void turn(const Rows& rows, const auto&... of) {
    over(rows, [&](const RowRange& r) { Base::turn(r, of...); });
  }
  template <class Real>
  Lists build_lists(const Rows& rows, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p) {
    return Base::build_lists(RowRange(rows), far, position, bin_start, p);
  }
  /// Calls make(rows) for the own rows if the host does not know their number yet.
  template <class Make>
  bool before_known(const Make& make) {
    if constexpr (requires { typename Base::UnknownRows; })
      if (rows_ && rows_->asked()) {
        const auto [first, last] = rows_->own();
        make(typename Base::UnknownRows{first, last, rows_->most()});
        return true;
      }
    return false;
  }
  /// If lists had too little memory on one rank, or messages between two, all ranks repeat the
  /// batch. Lists become long enough for what any rank needed: the others would need it soon.
  bool grow_lists(int n) {
    if (!rows_ || !Base::lists_overflow) return Base::grow_lists(n);
    ListDemand most;
    for (const ListDemand& d : of_all_ranks(Base::list_demand())) {
      most.overflows = std::max(most.overflows, d.overflows);
      most.longest = std::max(most.longest, d.longest);
    }
    Base::grow_lists(n, most);
    return rows_->forget_lost() || most.any();
  }
  template <class Updates>
  void repeat(int updates, Updates& u) {
    if (rows_)
      Base::repeat_unrecorded(updates, u);
    else
      Base::repeat(updates, u);
  }

  // What the solver calls on every rank; see RankRows.

  /// Null if there are no other ranks.
  RankRows<Base>* rows() { return rows_.get(); }
  template <class P, class C>
  bool before(C& c) {
    if (!rows_) return true;
    const bool launches = rows_->template before<P>(c);
    if (rows_->exchanged()) this->mark("exchange");
    return launches;
  }
  template <class C>
  void after(C& c) {
    if (rows_) rows_->after(c);
  }
  template <class Sums>
  void add_up(std::vector<Sums>& sums) {
    if (rows_) rows_->add_up(sums);
  }

 protected:
  /// repeat_while() with sums that the host waits for. Only one rank counts the repeats.
  template <class Sum, class Body>
  void repeat_from_host(const char* stage, int times, std::uint64_t limit,
                        unsigned long long* repeats, const Sum& sum, const Body& body) {
    for (int k = 0; k < times; ++k) {
      const std::uint64_t now = sum();
      this->mark(stage);
      if (now <= limit) return;
      if (!ranks_ || ranks_->rank() == 0) Base::add_one(repeats);
      body();
    }
  }

 private:
  /// Whether the number of rows, where it changes, is known to a device alone.
  static constexpr bool kDeviceCounts = requires { Base::counts_on_device; };

  /// Takes rows to their ranks between the pass that gives them their bins and the sort. Rows near
  /// solids, which such a pass leaves out, must have been predicted before.
  template <class First, class Near, class Gather>
  const int* sort_on_ranks(const char* stage, const First& of, const Near& near, const Rows& rows,
                           int bins, const int* id, int* order, int* start, const Gather& gather) {
    if constexpr (requires { near.pass; }) {
      throw Error(ExitCode::internal, "several ranks cannot run this sort");
    } else {
      const int of_layer = bins / rows_->layers();
      const BinSort sort{rows_->bins(of_layer), bins, id, order, start};
      if (sort.bins != std::exchange(sorted_bins_, sort.bins))  // no rows in others
        Base::clear(reinterpret_cast<char*>(start), std::size_t(bins + 1) * sizeof *start);
      Base::begin_sort(sort);
      const int all = rows_->route(*this, of.bin, of_layer, [&](const RowLists& to) {
        const auto pass = Base::counting(sort, SelectRowsPass<First>{of, to});
        over(rows, [&](const RowRange& r) {
          if constexpr (PairPass<First>)
            Base::pairs(r, pass);
          else
            Base::items(r, pass);
        });
        this->mark(stage);
      });
      Base::items(RowRange{rows.all, all}, Base::counting(sort, KnownBinPass{of.bin}));
      this->mark("exchange");
      if (not_counted_.size() == 0) not_counted_.resize(1);
      const int me = ranks_->rank();
      const GatherOwnPass<Gather> own{gather, start + rows_->slabs().low(me) * of_layer,
                                      start + rows_->slabs().high(me) * of_layer,
                                      not_counted_.data()};
      Base::sort_counted(sort, of.bin, all, own);
      return start + sort.bins.end;
    }
  }
  /// Calls launch(range) for own rows: at once, or for those at the cuts beside the others.
  template <class Launch>
  void over(const RowRange& own, const Launch& launch) {
    if constexpr (requires { this->has_edges(0); })
      if (rows_ && this->has_edges(own.last - own.first) && rows_->overlap()) {
        const auto [low, inner, high] = rows_->parts();
        const auto some = [&](const RowRange& r) {
          if (r.first < r.last) launch(r);
        };
        return this->beside([&] { some(low), some(high); }, [&] { some(inner); });
      }
    launch(own);
  }
  /// Steps that count nothing, in the memory of the executor.
  const StepCounts* no_steps() {
    if (no_steps_.size() == 0) {
      no_steps_.resize(1);
      const StepCounts none{};
      this->to_device(&none, 1, no_steps_.data());
    }
    return no_steps_.data();
  }
  template <class Sum>
  Sum over_ranks(const Sum& mine) {
    Sum total;
    for (const Sum& one : of_all_ranks(mine)) total.add(one);
    return total;
  }
  template <class T>
  std::vector<T> of_all_ranks(const T& mine) {
    const std::vector<char> bytes = ranks_->all_gather(&mine, sizeof mine);
    std::vector<T> all(bytes.size() / sizeof mine);
    std::memcpy(static_cast<void*>(all.data()), bytes.data(), bytes.size());
    return all;
  }

  Communicator* ranks_;
  std::unique_ptr<RankRows<Base>> rows_;
  typename Base::template Buffer<StepCounts> no_steps_, not_counted_;
  BinRange sorted_bins_{};  ///< of the last sort
};

}  // namespace pbf::PBF_VARIANT
