// Before a sort, particles go to the ranks of their layers.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <vector>

#include "kernels/pass_rank_rows.h"
#include "kernels/row_state.h"
#include "lib/base/error.h"
#include "lib/exec/ranks/communicator.h"
#include "lib/exec/ranks/slabs.h"

namespace pbf::PBF_VARIANT {

/// The rows of a solver before a sort.
struct SortedRows {
  RowFields fields{};  ///< what goes along with a particle
  int capacity = 0;    ///< rows
  RowRange own{0, 0};
  int all = 0;
};

/// Each particle goes to the rank of its layer, and a copy to those of the adjacent layers. The
/// bins of own rows that no longer belong here are outside the range of the sort, which leaves them
/// out. Old ghosts get no bin.
///
/// Either the ranks tell each other how many rows they send. Or, so that the host does not wait for
/// the device, messages have room for some more rows than the last ones had. Then learn() tells
/// afterwards whether any row was lost.
template <class Exec>
class RowRoutes {
 public:
  explicit RowRoutes(Communicator& ranks) : ranks_(ranks) {}

  /// Numbers of rows between this rank and the adjacent ones, and of those that go farther.
  using Counts = std::array<int, 5>;
  enum { go_down, go_up, go_far, come_down, come_up };

  /// The lists to fill before exchange(). bins: of a layer.
  RowLists lists(Exec& exec, const Slabs& slabs, int bins) {
    if (owner_of_ != slabs) {
      const std::vector<int>& owners = slabs.owners();
      owner_.resize(owners.size());
      exec.to_device(owners.data(), owners.size(), owner_.data());
      owner_of_ = slabs;
    }
    const int ranks = ranks_.size();
    count_.resize(std::size_t(ranks) + 1);
    list_.resize(std::size_t(ranks) * std::size_t(room_));
    exec.clear_own(reinterpret_cast<char*>(count_.data()), count_.bytes());
    return {{owner_.data(), int(slabs.owners().size()), bins, ranks_.rank()},
            list_.data(),
            count_.data(),
            room_,
            ranks};
  }
  /// select(): fills lists(). bin: of each own row. Returns the number of rows with those that
  /// came.
  template <class Select>
  int exchange(Exec& exec, const SortedRows& rows, int* bin, const Select& select) {
    const auto ranks = std::size_t(ranks_.size()), me = std::size_t(ranks_.rank());
    RowLists lists = select();
    std::vector<int> going = exec.values(count_.data(), int(ranks));
    for (int most; (most = *std::ranges::max_element(going)) > room_;) {
      room_ = most + most / 4;
      lists = select();
      going = exec.values(count_.data(), int(ranks));
    }
    std::vector<int> all(ranks * ranks), coming(ranks);
    const std::vector<char> bytes = ranks_.all_gather(going.data(), ranks * sizeof(int));
    std::memcpy(all.data(), bytes.data(), bytes.size());
    for (std::size_t r = 0; r < ranks; ++r) coming[r] = all[r * ranks + me];
    const int came = std::accumulate(coming.begin(), coming.end(), 0);
    if (rows.all + came > rows.capacity) throw too_many();

    const int words = rows.fields.words();
    const std::vector<Outgoing> out =
        messages<Outgoing>(send_, going, words, [&](int r, std::uint32_t* to, int n) {
          exec.items(n * words, PackRowsPass{rows.fields, lists.list + r * room_, to});
        });
    leave_ghosts(exec, rows, bin);
    const std::vector<Incoming> in =
        messages<Incoming>(receive_, coming, words, [](int, std::uint32_t*, int) {});
    exec.exchange(out, in);
    exec.items(came * words, UnpackRowsPass{rows.fields, receive_.data(), rows.all});
    const auto of = [&](const std::vector<int>& counts, std::size_t r) {
      return r < ranks ? counts[r] : 0;
    };
    known_ = {of(going, me - 1), of(going, me + 1), 0, of(coming, me - 1), of(coming, me + 1)};
    return rows.all + came;
  }
  /// The same with room for more rows than at the last exchange, without waiting for any rank.
  template <class Select>
  int exchange_counted(Exec& exec, const SortedRows& rows, int* bin, const Select& select) {
    for (std::size_t k = 0; k < known_.size(); ++k) most_[k] = room_for(known_[k]);
    room_ = std::max({room_, most_[go_down], most_[go_up]});
    const RowLists lists = select();
    const int words = rows.fields.words(), me = ranks_.rank();
    std::vector<Outgoing> out;
    std::vector<Incoming> in;
    reserve(send_, counted_words(words, most_[go_down]) + counted_words(words, most_[go_up]));
    reserve(receive_,
            counted_words(words, most_[come_down]) + counted_words(words, most_[come_up]));
    std::uint32_t *to = send_.data(), *from = receive_.data();
    for (const int r : {me - 1, me + 1}) {
      if (r < 0 || r >= ranks_.size()) continue;
      const int n = most_[r < me ? go_down : go_up], coming = most_[r < me ? come_down : come_up];
      exec.items(n * words, PackCountedPass{{rows.fields, lists.list + r * room_, to + kHeadWords},
                                            lists.count + r});
      out.push_back({r, to, counted_words(words, n) * sizeof *to});
      in.push_back({r, from, counted_words(words, coming) * sizeof *from});
      to += counted_words(words, n), from += counted_words(words, coming);
    }
    exec.exchange(out, in);
    leave_ghosts(exec, rows, bin);
    int all = rows.all;
    for (const Incoming& i : in) {
      const auto* head = static_cast<const std::uint32_t*>(i.data);
      int& n = most_[i.from < me ? come_down : come_up];
      n = std::min(n, rows.capacity - all);
      exec.items(n * words, UnpackCountedPass{{rows.fields, head + kHeadWords, all}, bin});
      all += n;
      heads_[i.from < me ? 0 : 1] = reinterpret_cast<const int*>(head);
    }
    return all;
  }
  /// Where learn() finds its counts, which are there after exchange_counted().
  std::array<const int*, 5> counts() const {
    const int me = ranks_.rank(), ranks = ranks_.size();
    const int *count = count_.data(), *none = count + me;
    return {me > 0 ? count + me - 1 : none, me + 1 < ranks ? count + me + 1 : none, count + ranks,
            me > 0 ? heads_[0] : none, me + 1 < ranks ? heads_[1] : none};
  }
  static void leave_ghosts(Exec& exec, const SortedRows& rows, int* bin) {
    exec.items(RowRange{0, rows.own.first}, WithoutBinPass{bin});
    exec.items(RowRange{rows.own.last, rows.all}, WithoutBinPass{bin});
  }
  /// After exchange_counted(). False if a row found no room, or went to another rank than the
  /// adjacent ones: the sort lacks it.
  bool learn(const Counts& counts) {
    bool good = counts[go_far] == 0;
    for (const int k : {go_down, go_up, come_down, come_up}) good = good && counts[k] <= most_[k];
    known_ = counts;
    return good;
  }

 private:
  template <class T>
  using Buffer = typename Exec::template Buffer<T>;

  static Error too_many() {
    return {ExitCode::unavailable,
            "too many particles for the memory of a rank; use other numbers of ranks"};
  }
  /// The same on both ranks of a message.
  static int room_for(int rows) { return rows + rows / 8 + 256; }
  static std::size_t counted_words(int words, int rows) {
    return std::size_t(kHeadWords) + std::size_t(rows) * std::size_t(words);
  }
  /// Those to or from ranks with so many rows each, one behind the other, and empty ones for the
  /// adjacent ranks, which always have a message. fill(rank, memory, rows)
  template <class Message, class Fill>
  std::vector<Message> messages(Buffer<std::uint32_t>& memory, const std::vector<int>& rows,
                                int words, const Fill& fill) {
    reserve(memory, std::accumulate(rows.begin(), rows.end(), std::size_t(0)) * std::size_t(words));
    std::vector<Message> all;
    std::uint32_t* at = memory.data();
    const int me = ranks_.rank();
    for (int r = 0; r < ranks_.size(); ++r) {
      const int n = rows[std::size_t(r)];
      if (n == 0 && r != me - 1 && r != me + 1) continue;
      const auto size = std::size_t(n) * std::size_t(words);
      all.push_back({r, at, size * sizeof *at});
      fill(r, at, n);
      at += size;
    }
    return all;
  }
  static void reserve(Buffer<std::uint32_t>& buffer, std::size_t words) {
    if (buffer.size() < words) buffer.resize(words + words / 4);
  }

  Communicator& ranks_;
  Slabs owner_of_;
  int room_ = 1024;
  Buffer<int> owner_, list_, count_;
  Buffer<std::uint32_t> send_, receive_;
  Counts known_{}, most_{};
  std::array<const int*, 2> heads_{};
};

}  // namespace pbf::PBF_VARIANT
