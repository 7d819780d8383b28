// Rows in the order of ids: each rank gets those of a range of ids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lib/exec/ranks/communicator.h"

namespace pbf::exec_module {

/// The ranges, in the order of ranks, of equal length but for the last. Their borders are whole
/// pages of what is written of them.
class IdRanges {
 public:
  IdRanges(std::int64_t particles, int ranks) : particles_(particles), ranks_(ranks) {}
  std::int64_t particles() const { return particles_; }
  std::int64_t first(int rank) const {
    return rank == ranks_ ? particles_ : particles_ * rank / ranks_ / kUnit * kUnit;
  }

 private:
  static constexpr std::int64_t kUnit = 1024;  ///< rows of 4 bytes in a page
  std::int64_t particles_;
  int ranks_;
};

/// Moves rows from where the particles are to the ranges of their ids. All ranks take part.
class ToRanges {
 public:
  /// ids: of this rank's rows, ascending. Throws Error(internal) if not every id is on one rank.
  ToRanges(Communicator& ranks, const IdRanges& ranges, const std::vector<std::int64_t>& ids);
  /// rows: of `size` bytes each, of the ids given. Returns those of this rank's range, in order.
  std::vector<std::byte> move(std::span<const std::byte> rows, std::size_t size);

 private:
  Communicator& ranks_;
  std::int64_t first_, count_;       ///< this rank's range
  std::vector<std::size_t> cut_;     ///< rows cut_[r] ... cut_[r + 1] - 1 go to rank r
  std::vector<std::size_t> coming_;  ///< the same of rows that come
  std::vector<std::int32_t> place_;  ///< of each row that comes, in the range
};

}  // namespace pbf::exec_module
