// A view of what the process writes to one file, write by write, and a disk that can be full.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pbf::test {

/// One change of the watched file.
struct DiskOperation {
  enum Kind { write, resize, mark, barrier } kind;  ///< barrier: all before is on the disk
  std::int64_t offset = 0;       ///< bytes; of a resize: the new size; of a mark: its number
  std::vector<std::byte> bytes;  ///< of a write
};

/// While it lives, writes, resizes and synchronisations of the file at `path` by this process are
/// recorded, and fail with ENOSPC where they would make the file longer than `capacity` bytes. One
/// at a time.
class WatchedDisk {
 public:
  explicit WatchedDisk(const std::string& path, std::int64_t capacity = INT64_MAX,
                       bool record = true);
  ~WatchedDisk();
  WatchedDisk(const WatchedDisk&) = delete;
  void mark(std::int64_t number);  ///< puts a mark between the operations
  std::vector<DiskOperation> operations() const;
  std::int64_t refused() const;  ///< writes that found the disk full
};

/// What writing a run file of so many frames, changing_sample(k), with 10 rows of the log before
/// each does to the disk. The mark k stands where the first k frames have been reported.
/// split: the rows of split_sample(k) are written by three ranks, or in pieces with gzip.
std::vector<DiskOperation> operations_of_a_run(const std::string& path, std::int64_t frames,
                                               bool gzip, bool split = false);

}  // namespace pbf::test
