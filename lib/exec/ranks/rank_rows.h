// The rows of a rank: which are its own, and how they are exchanged with other ranks.
//
// A rank has a slab of the layers of cells along the slowest axis of the grid. Its own rows are
// those of the particles in the slab. Copies of the rows of other ranks within one cell of the slab
// (ghosts) stand before and behind them. What is exchanged follows from the declarations of passes
// (lib/program/exchanges.h). All rows are in the memory of an executor.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <set>
#include <vector>

#include "kernels/pass_rank_rows.h"
#include "kernels/row_state.h"
#include "lib/exec/ranks/rank_fields.h"
#include "lib/exec/ranks/row_routes.h"
#include "lib/program/exchanges.h"
#include "lib/solver/internal_state.h"

namespace pbf::PBF_VARIANT {

template <class Exec>
class RankRows {
 public:
  explicit RankRows(Communicator& ranks) : ranks_(ranks), routes_(ranks) {}
  int first() { return known().first_; }        ///< own rows
  int last() { return known().last_; }          ///< excluded
  int all() { return known().all_; }            ///< with ghosts
  int particles() const { return particles_; }  ///< of all ranks
  /// What field::row_state is without ghosts.
  RowState row_state() { return {last() - first(), particles_}; }
  /// After a sort, until first(), last(), all() and what needs them: whether the executor knows
  /// these numbers and the host does not; where first() and last() are; the most that all() is.
  bool asked() const { return asked_ != nullptr; }
  std::array<const int*, 2> own() const { return own_; }
  int most() const { return all_; }
  const Slabs& slabs() const { return slabs_; }
  int layers() const { return int(slabs_.owners().size()); }
  /// Those of the slab and its ghosts. bins: of a layer.
  BinRange bins(int bins) const {
    const int me = ranks_.rank();
    return {std::max(slabs_.low(me) - 1, 0) * bins, std::min(slabs_.high(me) + 1, layers()) * bins};
  }
  /// Own rows: those at the cuts below and above, which other ranks have as ghosts and which have
  /// ghosts as neighbors, and those between.
  struct Parts {
    RowRange low, inner, high;
  };
  Parts parts() { return {{first(), low_end_}, {low_end_, high_begin_}, {high_begin_, last_}}; }
  /// Whether rows at the cuts are worth launches of their own in the pass of the last before(): an
  /// exchange comes next to it, and most rows are not at a cut.
  bool overlap() {
    known();
    return overlap_ && high_begin_ - low_end_ > (last_ - first_) / 2;
  }
  /// To be called between the launches of a pass that sums over particles.
  void add_within() const { add_within_(); }

  /// A start: the first sort takes particles to the ranks of their layers. Throws Error(bad_input)
  /// if the grid has too few layers.
  template <class Real>
  void begin(const InternalState<Real>& s, const Params<Real>& p, const Plan& plan,
             const Scene& scene) {
    std::vector<std::int64_t> in_layer(std::size_t(p.cells_z));
    for (const Vec4<Real>& x : s.position)
      ++in_layer[std::size_t(cell_coordinate(x.z, p.inv_cell, p.cells_z))];
    ranks_.sum(in_layer);
    slabs_ = Slabs(in_layer, ranks_.size(), layers_per_unit(plan));
    const Program& program = plan.program;
    RankState state;
    for (const std::vector<Exchange>& all :
         {exchanges_on_ranks(program, scene), exchanges(program, program.update, state)})
      for (std::size_t k = 0; k < all.size(); ++k)
        if (all[k].pass && (!all[k].ghosts.empty() || !all[(k + 1) % all.size()].ghosts.empty()))
          beside_exchange_.insert(all[k].pass);
    particles_ = int(std::accumulate(in_layer.begin(), in_layer.end(), std::int64_t(0)));
    only_own(int(s.id.size()));
  }
  /// Rows 0 ... n - 1 are this rank's, and there are no ghosts.
  template <class C>
  void all_own(C& c, int n) {
    only_own(n);
    counts_known_ = false;
    sorts_done_ = kBalanceEvery - 1;  // the next sort makes new cuts
    forget_near(c);
  }
  /// Leaves its own rows, moved to the front.
  template <class C>
  void drop_ghosts(C& c) {
    if (first() == 0 && last_ == all_) return;
    const int own = last_ - first_;
    forget_near(c);
    for (const FieldInfo* f : c.plan.program.fields)
      if (f->is_per_particle())
        if (char* begin = c.bytes_of(*f)) {
          const auto bytes = std::size_t(f->bytes(C::precision));
          c.exec.move_down(begin, std::size_t(first_) * bytes, std::size_t(own) * bytes);
        }
    only_own(own);
    c.put(field::row_state, {row_state()});
  }
  /// Integers of 64 bits become their sums over all ranks.
  template <class Sums>
  void add_up(std::vector<Sums>& sums) {
    static_assert(sizeof(Sums) % sizeof(std::int64_t) == 0);
    ranks_.sum({reinterpret_cast<std::int64_t*>(sums.data()),
                sums.size() * sizeof(Sums) / sizeof(std::int64_t)});
  }

  bool exchanged() const { return has_exchanged_; }  ///< in the last before()
  /// Before each launch of pass P: exchanges what it needs. False if another rank does it for all.
  template <class P, class C>
  bool before(C& c) {
    const Program& program = c.plan.program;
    const PassInfo& pass = program.passes[std::size_t(C::Passes::template index_of<P>())];
    const bool first = !c.iterating || c.iteration == 0;
    const Exchange e = exchanged_.before(pass, first, program);
    has_exchanged_ = !e.sums.empty() || !e.ghosts.empty();
    for (const FieldInfo* f : e.sums) add_up_field(c, *f, ranks_);
    if (ranks_.rank() != 0)
      for (const FieldInfo* f : e.from_zero) clear_field(c, *f);
    for (const FieldInfo* f : pass.flips) c.flip(*f);  // named as they are after the flips
    if (!e.ghosts.empty() && !lost()) copy_ghosts(c, e.ghosts);
    for (const FieldInfo* f : pass.flips) c.flip(*f);
    overlap_ = beside_exchange_.contains(&pass);
    sorts_ = !e.rows.empty();
    if (sorts_) {
      ++sorts_done_;
      if (!lost() && (sorts_done_ % kBalanceEvery == 0 || crowded_ || slabs_.unfinished()))
        balance(c);
      sorted_ = {row_fields(c, e.rows, pass), c.capacity(), {first_, last_}, all_};
    }
    for (const FieldInfo* f : e.sums_within) clear_field(c, *f);
    add_within_ = [this, &c, sums = e.sums_within] {
      for (const FieldInfo* f : sums) add_up_field(c, *f, ranks_);
    };
    return ranks_.rank() == 0 || !e.on_one_rank;
  }
  /// Within a pass that sorts: takes rows to their ranks. select(lists) runs a SelectRowsPass for
  /// the own rows, once. bin: of each row; bins: of a layer. Returns the number of rows to sort.
  template <class Select>
  int route(Exec& exec, int* bin, int bins, const Select& select) {
    bool selected = false;
    const auto lists = [&] {
      const RowLists to = routes_.lists(exec, slabs_, bins);
      if (std::exchange(selected, true))
        exec.items(RowRange{first_, last_}, ListRowsPass{bin, to});
      else
        select(to);
      return to;
    };
    counted_ = false;
    if (lost()) return lists(), routes_.leave_ghosts(exec, sorted_, bin), all_;
    counted_ = Exec::lists_overflow && in_batch_ && counts_known_ && careful_ == 0;
    all_ = counted_ ? routes_.exchange_counted(exec, sorted_, bin, lists)
                    : routes_.exchange(exec, sorted_, bin, lists);
    counts_known_ = true;
    return all_;
  }
  /// After it.
  template <class C>
  void after(C& c) {
    if (sorts_) find_own(c);
    sorts_ = false;
  }
  /// Updates in a batch may lose rows if the batch is repeated where lost() is true.
  void in_batch(bool now) { in_batch_ = now; }
  /// Whether any rank has lost a row, the same on all ranks. From then on they exchange no rows,
  /// because they no longer agree about the sizes of messages.
  bool lost() {
    agree();
    return lost_;
  }
  /// To be called on all ranks at the end of a batch: whether a rank has lost a row. Then none may
  /// be lost in the next batch, and in more and more batches if that goes on.
  bool forget_lost() {
    const bool any = lost();
    lost_ = false;
    if (any)
      careful_ = 1 << std::min(++losses_, 20);
    else if (careful_ > 0)
      --careful_;
    return any;
  }

 private:
  using Fields = Exchange::Fields;
  static constexpr int kBalanceEvery = 64;  ///< sorts

  /// All ranks learn whether one has lost a row in the last sort, or is crowded. The host gets here
  /// while the device makes lists, so that nothing waits.
  void agree() {
    known();
    if (agreed_) return;
    agreed_ = true;
    std::array<std::int64_t, 2> any{lost_, crowded_};
    ranks_.sum(any);
    lost_ = any[0] > 0, crowded_ = any[1] > 0;
  }
  /// Until the next sort no rows are known to be at a cut.
  void only_own(int n) {
    asked_ = nullptr;
    first_ = low_end_ = high_begin_ = 0, last_ = all_ = n;
  }

  /// New cuts, if ranks have become unequal: the same on all ranks.
  template <class C>
  void balance(C& c) {
    std::vector<std::int64_t> in_layer =
        c.exec.own_in_bins(c.p.cells_z, LayerPass<typename C::Real>{c.p, c.position()});
    ranks_.sum(in_layer);
    if (slabs_.balance(in_layer)) counts_known_ = false;
  }
  /// After a sort: which rows are this rank's, and which of them are ghosts elsewhere.
  template <class C>
  void find_own(C& c) {
    const int per_layer = bin_count(c.p) / layers(), me = ranks_.rank();
    const int low = slabs_.low(me), high = slabs_.high(me);
    const int* start = c.data(field::bin_start);
    std::array<const int*, 10> from{start + low * per_layer, start + (low + 1) * per_layer,
                                    start + (high - 1) * per_layer, start + high * per_layer,
                                    start + bins(per_layer).end};
    const std::array<const int*, 5> counts =
        counted_ ? routes_.counts() : std::array{start, start, start, start, start};
    std::ranges::copy(counts, from.begin() + 5);
    c.exec.ask(from);
    asked_ = &c.exec;
    own_ = {from[0], from[3]};
    agreed_ = false;
  }
  /// When the executor has answered.
  RankRows& known() {
    if (!asked_) return *this;
    const std::array<int, 10> at = std::exchange(asked_, nullptr)->template answer<10>();
    first_ = at[0], low_end_ = at[1], high_begin_ = at[2], last_ = at[3], all_ = at[4];
    if (counted_) lost_ = !routes_.learn({at[5], at[6], at[7], at[8], at[9]});
    crowded_ = slabs_.crowded(last_ - first_);
    if (ranks_.rank() == 0) low_end_ = first_;
    if (ranks_.rank() == ranks_.size() - 1) high_begin_ = last_;
    return *this;
  }
  template <class C>
  void copy_ghosts(C& c, const Fields& fields) {
    const int me = ranks_.rank();
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    const auto with = [&](int rank, int begin, int end, int ghosts, int ghosts_end) {
      if (rank < 0 || rank >= ranks_.size()) return;
      for (const FieldInfo* f : fields) {
        const auto bytes = std::size_t(f->bytes(C::precision));
        char* rows = c.bytes_of(*f);
        out.push_back({rank, rows + std::size_t(begin) * bytes, std::size_t(end - begin) * bytes});
        in.push_back(
            {rank, rows + std::size_t(ghosts) * bytes, std::size_t(ghosts_end - ghosts) * bytes});
      }
    };
    with(me - 1, first_, low_end_, 0, first_);
    with(me + 1, high_begin_, last_, last_, all_);
    c.exec.exchange_edges(out, in);
  }

  Communicator& ranks_;
  Slabs slabs_;
  RowRoutes<Exec> routes_;
  Exec* asked_ = nullptr;
  std::array<const int*, 2> own_{};
  int first_ = 0, last_ = 0, all_ = 0, low_end_ = 0, high_begin_ = 0;  ///< rows
  int particles_ = 0, sorts_done_ = 0;
  bool sorts_ = false, has_exchanged_ = false, overlap_ = false;
  bool in_batch_ = false, counts_known_ = false, counted_ = false;
  bool lost_ = false, crowded_ = false, agreed_ = true;
  int losses_ = 0, careful_ = 0;  ///< batches
  SortedRows sorted_;
  std::set<const PassInfo*> beside_exchange_;
  RankState exchanged_;
  std::function<void()> add_within_;
};

}  // namespace pbf::PBF_VARIANT
