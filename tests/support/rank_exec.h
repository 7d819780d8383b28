// An executor of one of two ranks in one process, and a driver that executes the passes of updates
// on both. What they exchange follows from the declarations of passes alone (exchanges.h).
#pragma once

#include <algorithm>
#include <barrier>
#include <cstring>
#include <functional>
#include <map>
#include <thread>
#include <vector>

#include "kernels/cell_index.h"
#include "lib/exec/cpu/cpu_exec.h"
#include "lib/program/exchanges.h"
#include "lib/program/make_program.h"
#include "lib/solver/granted.h"
#include "lib/solver/state_transfer.h"

namespace pbf::test {

/// Layers of cells in a brick of the levels: 4 cells of 2 x 2 x 2 cells of the search grid.
inline constexpr int kBrickLayers = 8;

/// Passes over particles run for the rank's own rows, sorts and lists for all.
class RankExec : public CpuExec {
 public:
  struct Rows {
    int first, last, all;
  };
  RankExec() : CpuExec(1, 37, Simd::scalar) {}
  int first = 0, last = 0;              ///< own rows
  int first_layer = 0, last_layer = 0;  ///< of cells along the slowest axis; the last excluded
  std::function<void()> add_sums;       ///< over both ranks, between the launches of a pass

  Rows counted(const RowState* state, int) const { return {first, last, int(state->rows)}; }
  using CpuExec::items;
  template <ItemPass Pass>
  void items(const Rows& rows, const Pass& pass) {
    for (int i = rows.first; i < rows.last; ++i) pass(i);
  }
  template <PairPass Pass>
  void pairs(const Rows& rows, const Pass& pass) {
    for (int i = rows.first; i < rows.last; ++i) sum_over_neighbors(pass, i);
  }
  /// Rows near solids are listed with those of ghosts.
  template <ItemPass Pass>
  void listed(const int* count, int, const Pass& pass) {
    for (int k = 0; k < *count; ++k) {
      if constexpr (requires { pass.row(k); })
        if (pass.row(k) < first || pass.row(k) >= last) continue;
      pass(k);
    }
  }
  /// The bricks of its layers, and then the sums over all bricks.
  template <BrickPass Pass>
  void bricks(const Pass& pass) {
    const int row = pass.grid.bricks(0) * pass.grid.bricks(1);
    for (int n = 0; n < pass.grid.bricks(); ++n)
      if (n / row * kBrickLayers >= first_layer && n / row * kBrickLayers < last_layer)
        of_brick(pass, n);
    add_sums();
  }
  template <bool leave, class First, class Near, class Gather>
  void sort_by_bin(const char* stage, const First& of, const Near& near, const Rows& rows, int bins,
                   const int* id, int* order, int* start, const Gather& gather) {
    CpuExec::sort_by_bin<leave>(stage, of, near, rows.all, bins, id, order, start, gather);
  }
  template <class Real>
  Lists build_lists(const Rows& rows, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p) {
    return CpuExec::build_lists(rows.all, far, position, bin_start, p);
  }
};

struct Counted {  // the number of rows changes as rows change ranks
  static constexpr bool changes_rows = true;
  using Passes = PassList<>;
  template <class B>
  static void add(const Scene&, B&) {}
};
using RankFeatures = Features::With<Counted>;

/// Two slabs of the grid along its slowest axis.
template <class Real>
class TwoRanks {
 public:
  using Context = StepContext<Real, RankExec, RankFeatures>;
  using Fields = Exchange::Fields;

  /// forget: a name in a list of exchanges that does not take place, for tests of this test.
  TwoRanks(const Scene& scene, const Plan& plan, Particles particles, std::string forget = {})
      : scene_(scene),
        plan_(plan),
        forget_(std::move(forget)),
        a_(exec_[0], scene_, plan_),
        b_(exec_[1], scene_, plan_) {
    // Half of the particles begin in each slab.
    InternalState<Real> all = to_internal<Real>(scene, plan.axes, std::move(particles)), none;
    std::vector<Vec4<Real>> places = all.position;
    std::nth_element(places.begin(), places.begin() + std::ptrdiff_t(places.size() / 2),
                     places.end(), [](const auto& x, const auto& y) { return x.z < y.z; });
    cut_ = std::max(1, layer_of(places[places.size() / 2]));
    if (plan.levels.all.count > 0)  // no brick is cut
      cut_ = std::max(1, (cut_ + kBrickLayers / 2) / kBrickLayers) * kBrickLayers;
    exec_[0].last_layer = exec_[1].first_layer = cut_;
    exec_[1].last_layer = a_.p.layers + kBrickLayers;
    exec_[0].last = int(all.id.size());
    for (Context* c : both()) c->make(c == &a_ ? all : none);
  }

  void step() {
    const double dt = scene_.time.step / plan_.substeps;
    for (Context* c : both())
      c->for_features([&](auto& memory) {
        memory.before_steps(*c, {updates_ * plan_.substeps, plan_.substeps, dt});
      });
    run(plan_.program.update, true);
    const int every = plan_.program.between_every;
    if (++updates_; every > 0 && updates_ % every == 0) run(plan_.program.between, true);
  }

  /// Position and velocity of each particle, by id.
  std::map<int, std::vector<Real>> state() {
    std::map<int, std::vector<Real>> out;
    for (Context* c : both())
      for (int i = c->exec.first; i < c->exec.last; ++i) {
        const Vec4<Real> x = c->position()[i], v = c->velocity()[i];
        out[c->ids()[i]] = {x.x, x.y, x.z, v.x, v.y, v.z};
      }
    return out;
  }
  /// Of walls and obstacles, which each rank has.
  std::vector<double> loads(int rank) {
    Context& c = *both()[std::size_t(rank)];
    if (!has_loads(scene_)) return {};
    return downloaded(c, field::loads, c.bytes_of(field::loads), c.kept_rows(field::loads),
                      nullptr);
  }
  int ghosts_at_most = 0, own_at_least = 1 << 30, moved = 0;

 private:
  std::array<Context*, 2> both() { return {&a_, &b_}; }

  void run(const Steps& steps, bool first) {
    for (const ProgramStep& s : steps) {
      if (s.kind == ProgramStep::pass) launch(s.index, first);
      for (int k = s.first; s.kind == ProgramStep::iterate && k < s.first + s.times; ++k) {
        for (Context* c : both()) c->iteration = k, c->iterating = true;
        run(s.body, first && k == 0);
        for (Context* c : both()) c->iterating = false;
      }
      for (int k = 0; s.kind == ProgramStep::until && k < s.times && compressed(); ++k)
        run(s.body, false);
    }
  }

  /// One sum over all ranks decides.
  bool compressed() {
    std::uint64_t sum = 0;
    for (Context* c : both())
      for (int i = c->exec.first; i < c->exec.last; ++i) sum += ResidualPass<Real>{c->density()}(i);
    return sum > residual_limit(plan_.tolerance, int(plan_.particles));
  }

  void launch(int index, bool first) {
    const PassInfo& pass = plan_.program.passes[std::size_t(index)];
    const Exchange e = state_.before(pass, first, plan_.program);
    for (const FieldInfo* f : e.sums) add_up(*f);
    for (const FieldInfo* f : e.from_zero)
      if (char* at = b_.bytes_of(*f))
        std::memset(at, 0, std::size_t(b_.rows_of(*f)) * row_bytes(*f));
    flip(pass);  // fields are named as they are after the flips
    for (const FieldInfo* f : e.ghosts)
      if (std::string(f->name) != forget_) copy_ghosts(*f);
    flip(pass);
    if (!e.rows.empty()) send_rows(e.rows);
    if (!e.sums_within.empty())
      launch_at_once(index, e.sums_within);
    else
      for (Context* c : both())
        if (c == &a_ || !e.on_one_rank) launch_pass<typename Context::Passes>(index, *c);
    if (!e.rows.empty()) take_slabs(e.rows);
    for (const AccessInfo& a : pass.declared)
      if ((a.how & (kWrites | kPlaces)) &&
          std::find(e.rows.begin(), e.rows.end(), a.field) == e.rows.end())
        poison(*a.field);
  }
  /// A pass of several launches: both ranks wait for each other where the sums are added up.
  void launch_at_once(int index, const Fields& sums) {
    for (const FieldInfo* f : sums)
      for (Context* c : both())
        std::memset(c->bytes_of(*f), 0, std::size_t(c->rows_of(*f)) * row_bytes(*f));
    std::barrier<std::function<void()>> both_are_here(2, [&]() {
      for (const FieldInfo* f : sums)
        if (std::string(f->name) != forget_) add_up(*f);
    });
    for (Context* c : both()) c->exec.add_sums = [&] { both_are_here.arrive_and_wait(); };
    std::thread second([&] { launch_pass<typename Context::Passes>(index, b_); });
    launch_pass<typename Context::Passes>(index, a_);
    second.join();
  }
  void flip(const PassInfo& pass) {
    for (const FieldInfo* f : pass.flips)
      for (Context* c : both()) c->flip(*f);
  }

  std::size_t row_bytes(const FieldInfo& f) const {
    return std::size_t(f.bytes(Context::precision));
  }
  int layer_of(Vec4<Real> x) const { return cell_coordinate(x.z, a_.p.inv_cell, a_.p.cells_z); }

  /// Each particle goes to the rank of its layer, and as a ghost to that of an adjacent layer.
  void send_rows(const Fields& fields) {
    struct Row {
      Vec4<Real> x;
      int from;
      std::vector<std::vector<char>> bytes;
    };
    std::vector<Row> rows;
    for (Context* c : both())
      for (int i = c->exec.last - 1; i >= c->exec.first; --i) {  // the order must not matter
        rows.push_back({c->position()[i], c == &a_ ? 0 : 1, {}});
        for (const FieldInfo* f : fields) {
          const char* at = c->bytes_of(*f) + std::size_t(i) * row_bytes(*f);
          rows.back().bytes.emplace_back(at, at + row_bytes(*f));
        }
      }
    for (Context* c : both()) {
      const int rank = c == &a_ ? 0 : 1;
      std::int64_t n = 0;
      for (const Row& r : rows) {
        const int layer = layer_of(r.x), owner = layer < cut_ ? 0 : 1;
        if (owner == rank && owner != r.from) ++moved;
        if (rank == 0 ? layer > cut_ : layer < cut_ - 1) continue;
        for (std::size_t k = 0; k < fields.size(); ++k)
          std::memcpy(c->bytes_of(*fields[k]) + std::size_t(n) * row_bytes(*fields[k]),
                      r.bytes[k].data(), r.bytes[k].size());
        ++n;
      }
      c->data(field::row_state)->rows = n;
      c->exec.first = 0, c->exec.last = int(n);
    }
  }
  /// After the sort the rows of a slab are adjacent. Nothing but `fields` came with the ghosts.
  void take_slabs(const Fields& fields) {
    for (Context* c : both()) {
      const int per_layer = bin_count(c->p) / c->p.layers;
      const int* start = c->data(field::bin_start);
      RankExec& exec = c->exec;
      exec.first = c == &a_ ? 0 : start[cut_ * per_layer];
      exec.last = c == &a_ ? start[cut_ * per_layer] : start[bin_count(c->p)];
      const int all = int(c->data(field::row_state)->rows);
      ghosts_at_most = std::max(ghosts_at_most, all - (exec.last - exec.first));
      own_at_least = std::min(own_at_least, exec.last - exec.first);
      row_of_[c == &a_ ? 0 : 1].clear();
      for (int i = exec.first; i < exec.last; ++i) row_of_[c == &a_ ? 0 : 1][c->ids()[i]] = i;
    }
    for (const FieldInfo* f : plan_.program.fields) {
      if (std::find(fields.begin(), fields.end(), f) == fields.end()) poison(*f);
      if (!f->pair) continue;
      for (Context* c : both()) c->flip(*f);
      poison(*f);
      for (Context* c : both()) c->flip(*f);
    }
  }
  void copy_ghosts(const FieldInfo& f) {
    for (int rank : {0, 1}) {
      Context &to = *both()[std::size_t(rank)], &from = *both()[std::size_t(1 - rank)];
      each_ghost(to, [&](int i) {
        const int row = row_of_[std::size_t(1 - rank)].at(to.ids()[i]);
        std::memcpy(to.bytes_of(f) + std::size_t(i) * row_bytes(f),
                    from.bytes_of(f) + std::size_t(row) * row_bytes(f), row_bytes(f));
      });
    }
  }
  void add_up(const FieldInfo& f) {
    if (f.type == Type::int64) return add_up<std::int64_t>(f);
    if (f.type == Type::int32) return add_up<std::int32_t>(f);
    throw Error(ExitCode::internal, "only whole numbers add up");
  }
  template <class Whole>
  void add_up(const FieldInfo& f) {
    auto* mine = reinterpret_cast<Whole*>(a_.bytes_of(f));
    auto* theirs = reinterpret_cast<Whole*>(b_.bytes_of(f));
    for (std::size_t k = 0; k < std::size_t(a_.rows_of(f)) * row_bytes(f) / sizeof(Whole); ++k)
      mine[k] = theirs[k] = mine[k] + theirs[k];
  }
  template <class F>
  static void each_ghost(Context& c, const F& f) {
    const int all = int(c.data(field::row_state)->rows);
    for (int i = 0; i < all; ++i)
      if (i < c.exec.first || i >= c.exec.last) f(i);
  }
  /// NaN in the rows of ghosts. Integers by row are numbers of rows or lists of them.
  void poison(const FieldInfo& f) {
    if (!f.primary().is_per_particle() || f.type != Type::real) return;
    for (Context* c : both())
      each_ghost(*c, [&](int i) {
        std::memset(c->bytes_of(f) + std::size_t(i) * row_bytes(f), 0xff, row_bytes(f));
      });
  }

  const Scene scene_;
  const Plan plan_;
  const std::string forget_;
  int cut_ = 0;  ///< first layer of the second rank
  RankExec exec_[2];
  Context a_, b_;
  RankState state_;
  std::map<int, int> row_of_[2];  ///< own rows by id
  std::int64_t updates_ = 0;
};

}  // namespace pbf::test
