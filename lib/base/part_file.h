// A file of which several processes write a part each, at places that the process that has made it
// tells them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lib/base/worker.h"

namespace pbf::base_module {

/// Number of a file in its file system; 0: it cannot be opened.
std::uint64_t inode_of(const std::string& path);

/// Waits until no PartFile of any process writes to files of this folder, such as one that a killed
/// run has left behind; false after some seconds. Always true where folders cannot be locked.
bool wait_for_parts(const std::string& folder, double seconds);

/// Writes from a thread of its own. Functions must not be called by several threads at a time.
class PartFile {
 public:
  struct Part {
    std::uint64_t at;  ///< bytes from the start of the file
    std::span<const std::byte> bytes;
  };
  /// Opens a file that is there. Throws Error(io).
  explicit PartFile(const std::string& path);
  ~PartFile();
  PartFile(const PartFile&) = delete;

  /// Queues the parts, and then to wait until the disk has stored them. owner: has their bytes.
  void write(std::vector<Part> parts, std::shared_ptr<const void> owner);
  /// Whether all that was queued is on the disk; waits for that if it shall. Throws Error(io) if a
  /// part could not be written.
  bool done(bool wait);

 private:
  void store(const std::vector<Part>& parts) const;
  [[noreturn]] void fail() const;

  const std::string path_;
  int file_ = -1, folder_ = -1;  ///< the folder is locked while this lives
  std::atomic<int> queued_{0};
  std::unique_ptr<Worker> worker_;  // last: its jobs use the rest
};

}  // namespace pbf::base_module
