// Before a sort, particles go to the ranks of their layers.
#pragma once

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

#include "kernels/pass_rank_rows.h"
#include "kernels/row_state.h"
#include "lib/base/error.h"
#include "lib/exec/ranks/communicator.h"
#include "lib/exec/ranks/slabs.h"
#include "lib/program/exchanges.h"

namespace pbf::PBF_VARIANT {

template <class Exec>
class RowRoutes {
 public:
  using Fields = Exchange::Fields;
  explicit RowRoutes(Communicator& ranks) : ranks_(ranks) {}

  /// Sends each particle to the rank of its layer, and a copy to those of the adjacent layers. Rows
  /// that no longer belong here get a negative id, and the sort leaves them out. own: rows of this
  /// rank, of all_rows. Returns the number of rows with those that came.
  template <class C>
  int exchange(C& c, const Slabs& slabs, const RowRange& own, int all_rows, const Fields& fields) {
    using Real = typename C::Real;
    const int me = ranks_.rank(), ranks = ranks_.size();
    slabs_ = slabs, own_ = own, all_ = all_rows;
    Selected rows;
    for (const int r : {me - 1, me + 1})
      if (r >= 0 && r < ranks) rows.to.push_back(r);
    select(c, rows);
    // How many rows come from the adjacent ranks, and whether any rank has some for others.
    struct Said {
      int down = 0, up = 0, far = 0;
    } said;
    for (std::size_t k = 0; k < rows.to.size(); ++k)
      (rows.to[k] < me ? said.down : said.up) = rows.count[k];
    said.far = rows.far;
    std::vector<Said> all(static_cast<std::size_t>(ranks));
    const std::vector<char> bytes = ranks_.all_gather(&said, sizeof said);
    std::memcpy(static_cast<void*>(all.data()), bytes.data(), bytes.size());
    std::vector<int> coming;
    if (std::ranges::all_of(all, [](const Said& s) { return s.far == 0; })) {
      for (const int r : rows.to) {
        const Said& s = all[std::size_t(r)];
        coming.push_back(r < me ? s.up : s.down);
      }
    } else {
      rows = {};
      for (int r = 0; r < ranks; ++r)
        if (r != me) rows.to.push_back(r);
      select(c, rows);
      coming = counts_for_me(rows);
    }
    const RanksOfRow<Real> of{c.p, c.position(), owner_.data()};
    const std::vector<Outgoing> out = packed(c, fields, rows);
    c.exec.items(all_, LeaveRowsPass<Real>{of, me, own.first, own.last, c.ids()});
    append(c, fields, rows.to, coming, out);
    return all_;
  }

 private:
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;
  /// Rows for other ranks: the lists and their lengths, in the order of `to`.
  struct Selected {
    std::vector<int> to{}, count{};
    int far = 0;  ///< rows that go beyond the adjacent ranks
  };

  std::vector<int> counts_for_me(const Selected& rows) {
    const auto ranks = std::size_t(ranks_.size()), me = std::size_t(ranks_.rank());
    std::vector<int> mine(ranks), all(ranks * ranks), coming;
    for (std::size_t k = 0; k < rows.to.size(); ++k) mine[std::size_t(rows.to[k])] = rows.count[k];
    const std::vector<char> bytes = ranks_.all_gather(mine.data(), ranks * sizeof(int));
    std::memcpy(all.data(), bytes.data(), bytes.size());
    for (const int r : rows.to) coming.push_back(all[std::size_t(r) * ranks + me]);
    return coming;
  }
  /// Makes the lists of own rows for rows.to, with more room where it is needed.
  template <class C>
  void select(C& c, Selected& rows) {
    using Real = typename C::Real;
    if (owner_of_ != slabs_) {
      const std::vector<int>& owners = slabs_.owners();
      owner_.resize(owners.size());
      c.exec.to_device(owners.data(), owners.size(), owner_.data());
      owner_of_ = slabs_;
    }
    const RanksOfRow<Real> of{c.p, c.position(), owner_.data()};
    const std::size_t lists = rows.to.size();
    std::vector<int> counts(lists + 1);
    for (;;) {
      if (list_.size() < lists * std::size_t(room_)) list_.resize(lists * std::size_t(room_));
      if (count_.size() < lists + 1) count_.resize(lists + 1);
      c.exec.clear(reinterpret_cast<char*>(count_.data()), (lists + 1) * sizeof(int));
      for (std::size_t k = 0; k < lists; ++k)
        c.exec.items(own_,
                     SelectRowsPass<Real>{of, rows.to[k], list_.data() + k * std::size_t(room_),
                                          count_.data() + k, room_});
      c.exec.items(own_, FarRowsPass<Real>{of, ranks_.rank(), count_.data() + lists});
      c.exec.to_host(count_.data(), lists + 1, counts.data());
      const int most = lists ? *std::max_element(counts.begin(), counts.end() - 1) : 0;
      if (most <= room_) break;
      room_ = most + most / 4;
    }
    rows.far = counts.back();
    counts.pop_back();
    rows.count = counts;
  }
  /// The rows of all fields for each rank, a field behind the other.
  template <class C>
  std::vector<Outgoing> packed(C& c, const Fields& fields, const Selected& rows) {
    const auto of_row = std::size_t(row_bytes(fields, C::precision));
    std::size_t bytes = 0;
    for (const int n : rows.count) bytes += std::size_t(n) * of_row;
    reserve(send_, bytes);
    std::vector<Outgoing> out;
    char* to = send_.data();
    for (std::size_t k = 0; k < rows.to.size(); ++k) {
      out.push_back({rows.to[k], to, std::size_t(rows.count[k]) * of_row});
      for (const FieldInfo* f : fields) {
        const int words = f->bytes(C::precision) / 4;
        c.exec.items(rows.count[k] * words,
                     PackRowsPass{reinterpret_cast<const std::uint32_t*>(c.bytes_of(*f)),
                                  list_.data() + k * std::size_t(room_), words,
                                  reinterpret_cast<std::uint32_t*>(to)});
        to += std::size_t(rows.count[k]) * std::size_t(words) * 4;
      }
    }
    return out;
  }
  /// Exchanges the rows and puts those that come behind all others.
  template <class C>
  void append(C& c, const Fields& fields, const std::vector<int>& from,
              const std::vector<int>& coming, const std::vector<Outgoing>& out) {
    const auto of_row = std::size_t(row_bytes(fields, C::precision));
    const auto more = std::accumulate(coming.begin(), coming.end(), std::int64_t(0));
    if (all_ + more > c.capacity())
      throw Error(ExitCode::unavailable,
                  "too many particles for the memory of a rank; use other numbers of ranks");
    reserve(receive_, std::size_t(more) * of_row);
    std::vector<Incoming> in;
    char* at = receive_.data();
    for (std::size_t k = 0; k < from.size(); ++k) {
      in.push_back({from[k], at, std::size_t(coming[k]) * of_row});
      at += in.back().bytes;
    }
    c.exec.exchange(out, in);
    at = receive_.data();
    for (const int n : coming) {
      for (const FieldInfo* f : fields) {
        const auto bytes = std::size_t(f->bytes(C::precision));
        c.exec.copy(at, c.bytes_of(*f) + std::size_t(all_) * bytes, std::size_t(n) * bytes);
        at += std::size_t(n) * bytes;
      }
      all_ += n;
    }
  }
  static void reserve(Buffer<char>& buffer, std::size_t bytes) {
    if (buffer.size() < bytes) buffer.resize(bytes + bytes / 4);
  }

  Communicator& ranks_;
  Slabs slabs_, owner_of_;
  RowRange own_{0, 0};
  int all_ = 0, room_ = 1024;
  Buffer<int> owner_, list_, count_;
  Buffer<char> send_, receive_;
};

}  // namespace pbf::PBF_VARIANT
