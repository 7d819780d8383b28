// The rows of a frame while it is written: on each rank those of a range of ids.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lib/base/part_file.h"
#include "lib/exec/ranks/communicator.h"
#include "lib/exec/ranks/id_ranges.h"
#include "lib/solver/split_rows.h"

namespace pbf::exec_module {

/// Functions as in SplitRows. All ranks take part in each; rank 0 alone gets rows.
class HeldFrame {
 public:
  HeldFrame(Communicator& ranks, std::int64_t particles)
      : ranks_(ranks), ranges_(particles, ranks.size()) {}

  /// copy: makes the rows of this rank's particles, in the order of ids.
  Snapshot hold(const std::function<Snapshot()>& copy);
  void held(std::size_t field, std::int64_t most, const TakeRows& take);
  bool share_file(const std::string& path, std::uint64_t inode);
  void write(const FramePlaces& places);
  bool written(bool wait);

  const IdRanges& ranges() const { return ranges_; }

 private:
  Communicator& ranks_;
  const IdRanges ranges_;
  std::shared_ptr<const Snapshot> rows_;  ///< also those that are being written
  std::unique_ptr<PartFile> file_;
};

}  // namespace pbf::exec_module
