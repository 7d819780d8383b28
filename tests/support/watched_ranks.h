// Ranks on the CPU that work as those on GPUs: messages have room for more rows, batches in which
// rows were lost are repeated, and rows at cuts are launched beside the others. All copies of rows
// that no exchange brings are NaN.
#pragma once

#include <algorithm>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "lib/exec/cpu/cpu_exec.h"
#include "lib/exec/periodic/periodic_exec.h"
#include "lib/exec/ranks/rank_exec.h"
#include "lib/solver/step_context.h"

namespace pbf::test {

/// What a rank is told, and what it has seen.
struct RankWatch {
  std::string forget{};               ///< name of the field whose exchanges bring nothing
  std::int64_t poisoned = 0;          ///< copies of rows
  int repeated = 0;                   ///< batches
  int most = 0;                       ///< own rows after a sort
  bool looks = true;                  ///< at rows after a sort, for which the host waits
  int early_lists = 0;                ///< made before the host knew for how many rows
  int split = 0;                      ///< passes with launches of their own for rows at cuts
  bool has_each_own_row_once = true;  ///< every launch over rows
};

/// Without vector instructions, so that it compiles faster. Writes down what is launched.
class EdgeCpu : public CpuExec {
 public:
  static constexpr bool lists_overflow = true;
  EdgeCpu() : CpuExec(1, 37, Simd::scalar) {}
  static int largest_batch(int) { return 16; }

  using CpuExec::items, CpuExec::pairs;
  template <ItemPass Pass>
  void items(const RowRange& rows, const Pass& pass) {
    launched_.emplace_back(rows.first, rows.last);
    CpuExec::items(rows, pass);
  }
  template <PairPass Pass>
  void pairs(const RowRange& rows, const Pass& pass) {
    launched_.emplace_back(rows.first, rows.last);
    for (int i = rows.first; i < rows.last; ++i) sum_over_neighbors(pass, i);
  }
  template <ItemPass Pass>
  void listed(const int* count, int most, const Pass& pass) {
    if constexpr (requires { pass.own; }) launched_.emplace_back(pass.own.first, pass.own.last);
    CpuExec::listed(count, most, pass);
  }

  /// As on a device, lists are made before the host knows for how many rows.
  struct UnknownRows {
    const int *first, *last;
    int most;
  };
  using CpuExec::build_lists;
  template <class Real>
  Lists build_lists(const UnknownRows& rows, int far, const Vec4<Real>* position,
                    const int* bin_start, const Params<Real>& p) {
    ++early_lists;
    return build_lists(RowRange{*rows.first, *rows.last}, far, position, bin_start, p);
  }
  int early_lists = 0;

  /// The sort of a device.
  void begin_sort(const BinSort& s) { counts_.resize(std::size_t(s.all) + 1); }
  template <class Pass>
  CountPass<true, Pass> counting(const BinSort& s, const Pass& pass) {
    return {pass, {s.bins, counts_.data(), s.order, s.id}};
  }
  template <class Gather>
  void sort_counted(const BinSort& s, const int* bin, int n, const Gather& gather) {
    const auto begin = counts_.begin() + s.bins.begin, end = counts_.begin() + s.bins.end;
    std::exclusive_scan(begin, end + 1, s.start + s.bins.begin, 0);
    slot_.resize(std::size_t(n));
    CpuExec::items(n, PlacePass{s.bins, bin, s.id, s.start, s.order, slot_.data(), counts_.data()});
    CpuExec::items(n, OrderPass<true, Gather>{s.bins, bin, s.id, s.start, slot_.data(), gather});
  }

  void exchange_edges(const std::vector<Outgoing>& out, const std::vector<Incoming>& in) {
    CpuExec::exchange_edges(out, in);
    arriving_ = in;
  }
  static bool has_edges(int) { return true; }
  /// The launches of inner() do not wait for the exchange before the pass: they find NaN.
  template <class Edges, class Inner>
  void beside(const Edges& edges, const Inner& inner) {
    edges();
    std::vector<std::vector<char>> came;
    for (const Incoming& i : arriving_) {
      auto* at = static_cast<char*>(i.data);
      came.emplace_back(at, at + i.bytes);
      std::memset(at, 0xff, i.bytes);
    }
    inner();
    for (std::size_t k = 0; k < came.size(); ++k)
      copy(came[k].data(), static_cast<char*>(arriving_[k].data), came[k].size());
  }

 protected:
  using Range = std::pair<int, int>;
  std::vector<Range> launched_{};     ///< over rows, in this pass
  std::vector<Incoming> arriving_{};  ///< for this pass

 private:
  std::vector<int> counts_{}, slot_{};
};

class WatchedExec : public PeriodicExec<RankExec<EdgeCpu>> {
  using Base = PeriodicExec<RankExec<EdgeCpu>>;

 public:
  WatchedExec(RankWatch& watch, Communicator& ranks) : Base(false, &ranks), watch_(watch) {}

  /// Only for lost rows: lists on the CPU grow as they are made.
  bool grow_lists(int n) {
    const bool repeats = Base::grow_lists(n);
    watch_.repeated += repeats;
    return repeats;
  }
  /// This is how a sum over ranks arrives.
  template <class T>
  void to_device(const T* host, std::size_t n, T* to) {
    if (static_cast<void*>(to) != forgotten_sum_) Base::to_device(host, n, to);
  }
  template <class P, class C>
  bool before(C& c) {
    const Program& program = c.plan.program;
    pass_ = &program.passes[std::size_t(C::Passes::template index_of<P>())];
    exchange_ = state_.before(*pass_, !c.iterating || c.iteration == 0, program);
    forgotten_sum_ = nullptr;
    for (const auto* sums : {&exchange_.sums, &exchange_.sums_within})
      for (const FieldInfo* f : *sums)
        if (f->name == watch_.forget) forgotten_sum_ = c.bytes_of(*f);
    const bool launches = Base::template before<P>(c);
    for (const FieldInfo* f : pass_->flips) c.flip(*f);  // named as they are after the flips
    for (const FieldInfo* f : exchange_.ghosts)
      if (f->name == watch_.forget) poison(c, *f, c.bytes_of(*f));
    for (const FieldInfo* f : pass_->flips) c.flip(*f);
    launched_.clear();
    return launches;
  }
  template <class C>
  void after(C& c) {
    const bool sorts = !exchange_.rows.empty();
    look_at_launches(sorts);
    arriving_.clear();
    Base::after(c);
    watch_.early_lists = early_lists;
    if (sorts) {
      if (!watch_.looks) return;
      watch_.most = std::max(watch_.most, rows()->last() - rows()->first());
      for (const FieldMemory& a : c.arrays())
        if (a.second || std::ranges::find(exchange_.rows, a.field) == exchange_.rows.end())
          poison(c, *a.field, a.begin);
    } else {
      for (const AccessInfo& a : pass_->declared)
        if (a.how & (kWrites | kPlaces)) poison(c, *a.field, c.bytes_of(*a.field));
    }
  }

 private:
  /// Either all own rows are launched at once, or those at the cuts and then the others.
  /// first_only: a sort has other launches for ranges behind these.
  void look_at_launches(bool first_only) {
    const auto [low, inner, high] = rows()->parts();
    std::vector<Range> wanted{{rows()->first(), rows()->last()}};
    if (rows()->overlap()) {
      wanted = {{low.first, low.last}, {high.first, high.last}, {inner.first, inner.last}};
      std::erase_if(wanted, [](const Range& r) { return r.first == r.second; });
      watch_.split += !launched_.empty();
    }
    if (first_only) launched_.resize(wanted.size());
    bool good = launched_.size() % wanted.size() == 0;
    for (std::size_t k = 0; k < launched_.size(); ++k)
      good = good && launched_[k] == wanted[k % wanted.size()];
    watch_.has_each_own_row_once = watch_.has_each_own_row_once && good;
  }
  /// NaN in the copies of other ranks' rows. Integers by row are numbers of rows or lists of them.
  template <class C>
  void poison(const C&, const FieldInfo& f, char* begin) {
    if (!begin || !f.primary().is_per_particle() || f.type != Type::real) return;
    const auto row = std::size_t(f.bytes(C::precision));
    for (const auto& [first, last] :
         {Range{0, rows()->first()}, Range{rows()->last(), rows()->all()}}) {
      std::memset(begin + std::size_t(first) * row, 0xff, std::size_t(last - first) * row);
      watch_.poisoned += last - first;
    }
  }

  RankWatch& watch_;
  RankState state_{};
  const PassInfo* pass_ = nullptr;
  Exchange exchange_{};  ///< of this pass
  void* forgotten_sum_ = nullptr;
};

}  // namespace pbf::test
