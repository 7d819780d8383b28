// Memory of the host for the rows of ranks (lib/exec/ranks/rank_rows.h).
#pragma once

#include <array>
#include <cstring>
#include <vector>

#include "kernels/hd.h"
#include "lib/exec/ranks/pieces.h"

namespace pbf::PBF_VARIANT {

class CpuRows {
 public:
  void connect(Communicator& ranks) { ranks_ = &ranks; }
  /// Sends and receives memory; several pieces between two ranks are one message.
  void exchange(const std::vector<Outgoing>& out, const std::vector<Incoming>& in) {
    if (single(out, in)) return ranks_->exchange(out, in);
    const auto take = [&](const char* from, std::size_t bytes, char* to) { copy(from, to, bytes); };
    exchange_joined(*ranks_, out, in, take, take);
  }
  /// The same, of rows at the cuts.
  void exchange_edges(const std::vector<Outgoing>& out, const std::vector<Incoming>& in) {
    exchange(out, in);
  }
  void clear(char* at, std::size_t bytes) { std::memset(at, 0, bytes); }
  void clear_own(char* at, std::size_t bytes) { clear(at, bytes); }
  /// The same for memory of which much may stay unused: it gives pages back to the system, which
  /// are 0 when they are touched.
  void clear_pages(char* at, std::size_t bytes);
  void copy(const char* from, char* to, std::size_t bytes) {
    if (bytes) std::memcpy(to, from, bytes);
  }
  /// Moves bytes from begin + by to `begin`.
  void move_down(char* begin, std::size_t by, std::size_t bytes) {
    std::memmove(begin, begin + by, bytes);
  }
  std::vector<int> values(const int* from, int n) { return {from, from + n}; }
  /// The numbers at some places, as they are behind what was launched; answer() waits for them.
  template <std::size_t n>
  void ask(const std::array<const int*, n>& from) {
    asked_.assign(from.begin(), from.end());
  }
  template <std::size_t n>
  std::array<int, n> answer() {
    std::array<int, n> out;
    for (std::size_t k = 0; k < n; ++k) out[k] = *asked_[k];
    return out;
  }

 private:
  Communicator* ranks_ = nullptr;
  std::vector<const int*> asked_{};
};

}  // namespace pbf::PBF_VARIANT
