// Finds where an output path leads.
#pragma once

#include <sys/stat.h>

#include <string>

namespace pbf::base_module {

/// The end of all links of a path. It need not exist yet.
struct OutputTarget {
  std::string path;
  int descriptor = -1;  ///< of this process, when the path names one (/dev/stdout, /dev/fd/N)
  bool there = false;
  struct stat status {};  ///< when it is there

  /// Whether it is written directly instead of being replaced.
  bool stream() const { return descriptor >= 0 || (there && !S_ISREG(status.st_mode)); }
  /// The folder of `path`.
  std::string folder() const;
};

/// For a path that the user gave. Throws Error(io) if the links form a loop or lead to a folder, a
/// socket or a block device, and Error(bad_input) for a file that the command reads.
OutputTarget output_target(const std::string& path);

/// For a file that the program names itself; see require_own_file().
OutputTarget own_target(const std::string& path);

/// Throws Error(io) if the file cannot be created or replaced: "its folder x cannot be written:
/// Permission denied". `path`, as the user wrote it, begins the message.
void require_writable(const OutputTarget& target, const std::string& path);

/// Opens a target that is a stream for writing. Throws Error(io), also for a FIFO without a reader.
/// `path`, as the user wrote it, begins the message.
int open_stream(const OutputTarget& target, const std::string& path);

}  // namespace pbf::base_module
