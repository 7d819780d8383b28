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
    const auto ranks = std::size_t(ranks_.size()), me = std::size_t(ranks_.rank());
    if (owner_of_ != slabs) {
      const std::vector<int>& owners = slabs.owners();
      owner_.resize(owners.size());
      c.exec.to_device(owners.data(), owners.size(), owner_.data());
      owner_of_ = slabs;
    }
    const RanksOfRow<Real> of{c.p, c.position(), owner_.data()};
    const std::vector<int> going = select(c, of, own);
    std::vector<int> all(ranks * ranks), coming(ranks);
    const std::vector<char> bytes = ranks_.all_gather(going.data(), ranks * sizeof(int));
    std::memcpy(all.data(), bytes.data(), bytes.size());
    for (std::size_t r = 0; r < ranks; ++r) coming[r] = all[r * ranks + me];
    const RowFields rows = rows_of(c, fields);
    const std::vector<Outgoing> out = packed(c, rows, going);
    leave(c, of, own, all_rows, going);
    return append(c, rows, all_rows, coming, out);
  }

 private:
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;

  template <class C>
  static RowFields rows_of(C& c, const Fields& fields) {
    RowFields rows;
    if (fields.size() > std::size_t(RowFields::most))
      throw Error(ExitCode::internal, "too many fields go along with particles");
    for (const FieldInfo* f : fields) {
      const int k = rows.fields++;
      rows.rows[k] = reinterpret_cast<std::uint32_t*>(c.bytes_of(*f));
      rows.begin[k + 1] = rows.begin[k] + f->bytes(C::precision) / 4;
    }
    return rows;
  }
  /// Makes the list of own rows for each rank, with more room where it is needed. Returns their
  /// lengths.
  template <class C, class Real>
  std::vector<int> select(C& c, const RanksOfRow<Real>& of, const RowRange& own) {
    const int ranks = ranks_.size();
    count_.resize(std::size_t(ranks));
    for (;;) {
      list_.resize(std::size_t(ranks) * std::size_t(room_));
      c.exec.clear(reinterpret_cast<char*>(count_.data()), count_.bytes());
      c.exec.items(own,
                   SelectRowsPass<Real>{of, ranks_.rank(), list_.data(), count_.data(), room_});
      std::vector<int> counts = c.exec.values(count_.data(), ranks);
      const int most = *std::ranges::max_element(counts);
      if (most <= room_) return counts;
      room_ = most + most / 4;
    }
  }
  const int* list(std::size_t rank) { return list_.data() + rank * std::size_t(room_); }
  /// Whether this rank sends a message of so many rows to another: those that it always has
  /// something for get an empty one, too.
  bool sends(std::size_t rank, int rows) const {
    const int to = int(rank), me = ranks_.rank();
    return rows > 0 || to == me - 1 || to == me + 1;
  }
  template <class C>
  std::vector<Outgoing> packed(C& c, const RowFields& rows, const std::vector<int>& going) {
    const int words = rows.words();
    reserve(send_, words, going);
    std::vector<Outgoing> out;
    std::uint32_t* to = send_.data();
    for (std::size_t r = 0; r < going.size(); ++r) {
      if (!sends(r, going[r])) continue;
      const auto all = std::size_t(going[r]) * std::size_t(words);
      out.push_back({int(r), to, all * sizeof *to});
      c.exec.items(int(all), PackRowsPass{rows, list(r), to});
      to += all;
    }
    return out;
  }
  template <class C, class Real>
  void leave(C& c, const RanksOfRow<Real>& of, const RowRange& own, int all_rows,
             const std::vector<int>& going) {
    for (std::size_t r = 0; r < going.size(); ++r)
      c.exec.items(going[r], LeaveListedPass<Real>{of, ranks_.rank(), list(r), c.ids()});
    c.exec.items(RowRange{0, own.first}, LeaveGhostsPass{c.ids()});
    c.exec.items(RowRange{own.last, all_rows}, LeaveGhostsPass{c.ids()});
  }
  /// Exchanges the rows and puts those that come behind all others. Returns the number of all.
  template <class C>
  int append(C& c, const RowFields& rows, int all_rows, const std::vector<int>& coming,
             const std::vector<Outgoing>& out) {
    if (std::accumulate(coming.begin(), coming.end(), std::int64_t(all_rows)) > c.capacity())
      throw Error(ExitCode::unavailable,
                  "too many particles for the memory of a rank; use other numbers of ranks");
    const int words = rows.words();
    reserve(receive_, words, coming);
    std::vector<Incoming> in;
    std::uint32_t* at = receive_.data();
    for (std::size_t r = 0; r < coming.size(); ++r) {
      if (!sends(r, coming[r])) continue;
      in.push_back({int(r), at, std::size_t(coming[r]) * std::size_t(words) * sizeof *at});
      at += std::size_t(coming[r]) * std::size_t(words);
    }
    c.exec.exchange(out, in);
    const auto came = int(at - receive_.data());
    c.exec.items(came, UnpackRowsPass{rows, receive_.data(), all_rows});
    return all_rows + came / words;
  }
  static void reserve(Buffer<std::uint32_t>& buffer, int words, const std::vector<int>& rows) {
    const auto n = std::accumulate(rows.begin(), rows.end(), std::size_t(0)) * std::size_t(words);
    if (buffer.size() < n) buffer.resize(n + n / 4);
  }

  Communicator& ranks_;
  Slabs owner_of_;
  int room_ = 1024;
  Buffer<int> owner_, list_, count_;
  Buffer<std::uint32_t> send_, receive_;
};

}  // namespace pbf::PBF_VARIANT
