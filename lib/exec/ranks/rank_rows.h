// The rows of a rank: which are its own, and how they are exchanged with other ranks.
//
// A rank has a slab of the layers of cells along the slowest axis of the grid. Its own rows are
// those of the particles in the slab. Copies of the rows of other ranks within one cell of the slab
// (ghosts) stand before and behind them. What is exchanged follows from the declarations of passes
// (lib/program/exchanges.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <vector>

#include "kernels/cell_index.h"
#include "lib/exec/ranks/communicator.h"
#include "lib/exec/ranks/slabs.h"
#include "lib/program/exchanges.h"
#include "lib/program/features/solids.h"
#include "lib/solver/internal_state.h"

namespace pbf::PBF_VARIANT {

class RankRows {
 public:
  explicit RankRows(Communicator& ranks) : ranks_(ranks) {}
  int first() const { return first_; }          ///< own rows
  int last() const { return last_; }            ///< excluded
  int particles() const { return particles_; }  ///< of all ranks
  const Slabs& slabs() const { return slabs_; }
  /// To be called between the launches of a pass that sums over particles.
  void add_within() const { add_within_(); }

  /// Leaves to this rank its own particles of a start, which every rank has. Throws
  /// Error(bad_input) if the grid has too few layers.
  template <class Real>
  void take_own(InternalState<Real>& s, const Params<Real>& p, const Plan& plan) {
    particles_ = int(s.id.size());
    std::vector<std::int64_t> in_layer(std::size_t(p.cells_z));
    for (const Vec4<Real>& x : s.position) ++in_layer[std::size_t(layer_of(x, p))];
    slabs_ = Slabs(in_layer, ranks_.size(), layers_per_unit(plan));
    std::size_t own = 0;
    for (std::size_t i = 0; i < s.id.size(); ++i)
      if (slabs_.owner(layer_of(s.position[i], p)) == ranks_.rank()) {
        s.position[own] = s.position[i];
        s.velocity[own] = s.velocity[i];
        s.id[own++] = s.id[i];
      }
    s.position.resize(own), s.velocity.resize(own), s.id.resize(own);
    first_ = 0, last_ = int(own);
  }
  /// Rows 0 ... n - 1 are this rank's, and there are no ghosts.
  template <class C>
  void all_own(C& c, int n) {
    first_ = 0, last_ = n;
    forget_near(c);
  }
  /// Leaves its own rows, moved to the front; false if there were no others.
  template <class C>
  bool drop_ghosts(C& c) {
    RowState& rows = *c.data(field::row_state);
    if (first_ == 0 && last_ == rows.rows) return false;
    rows.rows = last_ - first_;
    forget_near(c);
    for (const FieldInfo* f : c.plan.program.fields)
      if (f->is_per_particle()) {
        char* begin = c.bytes_of(*f);
        const auto bytes = std::size_t(f->bytes(C::precision));
        if (begin)
          std::memmove(begin, begin + std::size_t(first_) * bytes, std::size_t(rows.rows) * bytes);
      }
    first_ = 0, last_ = int(rows.rows);
    return true;
  }
  /// Integers of 64 bits become their sums over all ranks.
  template <class Sums>
  void add_up(std::vector<Sums>& sums) {
    static_assert(sizeof(Sums) % sizeof(std::int64_t) == 0);
    ranks_.sum({reinterpret_cast<std::int64_t*>(sums.data()),
                sums.size() * sizeof(Sums) / sizeof(std::int64_t)});
  }

  /// Before each launch of pass P: exchanges what it needs. False if another rank does it for all.
  template <class P, class C>
  bool before(C& c) {
    const Program& program = c.plan.program;
    const PassInfo& pass = program.passes[std::size_t(C::Passes::template index_of<P>())];
    const bool first = !c.iterating || c.iteration == 0;
    const Exchange e = exchanged_.before(pass, first, program);
    for (const FieldInfo* f : e.sums) add_up(c, *f);
    if (ranks_.rank() != 0)
      for (const FieldInfo* f : e.from_zero) clear(c, *f);
    for (const FieldInfo* f : pass.flips) c.flip(*f);  // named as they are after the flips
    if (!e.ghosts.empty()) copy_ghosts(c, e.ghosts);
    for (const FieldInfo* f : pass.flips) c.flip(*f);
    sorts_ = !e.rows.empty();
    if (sorts_) route(c, e.rows);
    for (const FieldInfo* f : e.sums_within) clear(c, *f);
    add_within_ = [this, &c, sums = e.sums_within] {
      for (const FieldInfo* f : sums) add_up(c, *f);
    };
    return ranks_.rank() == 0 || !e.on_one_rank;
  }
  /// After it.
  template <class C>
  void after(C& c) {
    if (sorts_) find_own(c);
    sorts_ = false;
  }

 private:
  using Fields = Exchange::Fields;
  static constexpr int kBalanceEvery = 64;  ///< sorts

  template <class Real>
  static int layer_of(const Vec4<Real>& x, const Params<Real>& p) {
    return cell_coordinate(x.z, p.inv_cell, p.cells_z);
  }
  template <class C>
  static std::size_t bytes_in_all(C& c, const FieldInfo& f) {
    return std::size_t(c.rows_of(f)) * std::size_t(f.bytes(C::precision));
  }
  template <class C>
  static void clear(C& c, const FieldInfo& f) {
    if (char* at = c.bytes_of(f)) std::memset(at, 0, bytes_in_all(c, f));
  }
  template <class C>
  void add_up(C& c, const FieldInfo& f) {
    char* at = c.bytes_of(f);
    if (f.type == Type::int64)
      return ranks_.sum({reinterpret_cast<std::int64_t*>(at), bytes_in_all(c, f) / 8});
    if (f.type != Type::int32) throw Error(ExitCode::internal, "only whole numbers add up");
    auto* words = reinterpret_cast<std::int32_t*>(at);
    const std::size_t n = bytes_in_all(c, f) / 4;
    std::vector<std::int64_t> wide(words, words + n);
    ranks_.sum(wide);
    std::copy(wide.begin(), wide.end(), words);
  }

  /// No row counts as near a solid. The features mark those that they know of, which are not all
  /// for which there is memory.
  template <class C>
  static void forget_near(C& c) {
    auto* way = c.data(field::near_way_left);
    if (!way) return;
    const int* row = c.data(field::near_row);
    for (int k = 0; k < *c.data(field::near_count); ++k) way[row[k]] = 0;
    *c.data(field::near_count) = 0;
  }
  /// Sends each particle to the rank of its layer, and a copy to those of the adjacent layers. Rows
  /// that no longer belong here get a negative id, and the sort leaves them out.
  template <class C>
  void route(C& c, const Fields& fields) {
    const int me = ranks_.rank(), n = ranks_.size();
    RowState& rows = *c.data(field::row_state);
    int* id = c.ids();
    const auto* position = c.position();
    if (++sorts_done_ % kBalanceEvery == 0) balance(c);
    for (int i = 0; i < rows.rows; ++i)
      if (i < first_ || i >= last_) id[i] = -1 - id[i];
    std::vector<std::vector<int>> to(static_cast<std::size_t>(n));
    for (int i = first_; i < last_; ++i) {
      const int layer = layer_of(position[i], c.p);
      const int low = slabs_.owner(std::max(layer - 1, 0));
      const int high = slabs_.owner(std::min(layer + 1, c.p.cells_z - 1));
      for (int r = low; r <= high; ++r)
        if (r != me) to[std::size_t(r)].push_back(i);
      if (me < low || me > high) gone_.push_back(i);
    }
    std::int64_t far = 0;
    for (int r = 0; r < n; ++r) far += std::abs(r - me) > 1 && !to[std::size_t(r)].empty();
    ranks_.sum({&far, 1});
    std::vector<Parcel> out, in;
    for (int r = 0; r < n; ++r) {
      if (r == me || (far == 0 && std::abs(r - me) > 1)) continue;
      out.push_back({r, packed(c, fields, to[std::size_t(r)])});
      in.push_back({r, {}});
    }
    for (const int i : gone_) id[i] = -1 - id[i];
    gone_.clear();
    ranks_.exchange(out, in);
    for (const Parcel& p : in) append(c, fields, p.bytes, rows);
  }
  template <class C>
  static std::vector<char> packed(C& c, const Fields& fields, const std::vector<int>& rows) {
    std::vector<char> all;
    for (const FieldInfo* f : fields) {
      const auto bytes = std::size_t(f->bytes(C::precision));
      const char* from = c.bytes_of(*f);
      const std::size_t begin = all.size();
      all.resize(begin + rows.size() * bytes);
      for (std::size_t k = 0; k < rows.size(); ++k)
        std::memcpy(all.data() + begin + k * bytes, from + std::size_t(rows[k]) * bytes, bytes);
    }
    return all;
  }
  template <class C>
  static void append(C& c, const Fields& fields, const std::vector<char>& all, RowState& rows) {
    const auto of_row = std::size_t(row_bytes(fields, C::precision));
    const std::size_t n = all.size() / of_row;
    if (rows.rows + std::int64_t(n) > c.capacity())
      throw Error(ExitCode::unavailable, "too many particles for the memory of a rank");
    const char* from = all.data();
    for (const FieldInfo* f : fields) {
      const auto bytes = std::size_t(f->bytes(C::precision));
      if (n) std::memcpy(c.bytes_of(*f) + std::size_t(rows.rows) * bytes, from, n * bytes);
      from += n * bytes;
    }
    rows.rows += std::int64_t(n);
  }
  /// New cuts, if the ranks have become unequal. They follow from what all ranks know.
  template <class C>
  void balance(C& c) {
    std::vector<std::int64_t> in_layer(std::size_t(c.p.cells_z));
    for (int i = first_; i < last_; ++i) ++in_layer[std::size_t(layer_of(c.position()[i], c.p))];
    ranks_.sum(in_layer);
    slabs_.balance(in_layer);
  }
  /// After a sort: which rows are this rank's, and which of them are ghosts elsewhere.
  template <class C>
  void find_own(C& c) {
    const int per_layer = bin_count(c.p) / c.p.layers, me = ranks_.rank();
    const int* start = c.data(field::bin_start);
    const auto begin = [&](int layer) { return start[layer * per_layer]; };
    const int low = slabs_.low(me), high = slabs_.high(me);
    first_ = begin(low), last_ = begin(high);
    low_end_ = begin(low + 1), high_begin_ = begin(high - 1);
  }
  template <class C>
  void copy_ghosts(C& c, const Fields& fields) {
    const int me = ranks_.rank(), all = int(c.data(field::row_state)->rows);
    std::vector<Parcel> out, in;
    std::vector<std::array<int, 2>> into;
    const auto with = [&](int rank, int begin, int end, int ghosts, int ghosts_end) {
      if (rank < 0 || rank >= ranks_.size()) return;
      Parcel p{rank, {}};
      for (const FieldInfo* f : fields) {
        const auto bytes = std::size_t(f->bytes(C::precision));
        const char* from = c.bytes_of(*f);
        p.bytes.insert(p.bytes.end(), from + std::size_t(begin) * bytes,
                       from + std::size_t(end) * bytes);
      }
      out.push_back(std::move(p));
      in.push_back({rank, {}});
      into.push_back({ghosts, ghosts_end});
    };
    with(me - 1, first_, low_end_, 0, first_);
    with(me + 1, high_begin_, last_, last_, all);
    ranks_.exchange(out, in);
    for (std::size_t k = 0; k < in.size(); ++k) {
      const auto n = std::size_t(into[k][1] - into[k][0]);
      if (in[k].bytes.size() != n * std::size_t(row_bytes(fields, C::precision)))
        throw Error(ExitCode::internal, "ghosts of another number than their rank sends");
      const char* from = in[k].bytes.data();
      for (const FieldInfo* f : fields) {
        const auto bytes = std::size_t(f->bytes(C::precision));
        if (n) std::memcpy(c.bytes_of(*f) + std::size_t(into[k][0]) * bytes, from, n * bytes);
        from += n * bytes;
      }
    }
  }

  Communicator& ranks_;
  Slabs slabs_;
  int first_ = 0, last_ = 0, low_end_ = 0, high_begin_ = 0;  ///< rows
  int particles_ = 0, sorts_done_ = 0;
  bool sorts_ = false;
  RankState exchanged_;
  std::function<void()> add_within_;
  std::vector<int> gone_;
};

}  // namespace pbf::PBF_VARIANT
