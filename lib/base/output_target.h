// Finds the target of an output path that the user gave.
#pragma once

#include <sys/stat.h>

#include <string>

namespace pbf::inline base_module {

/// Links are followed, also to what is not there yet.
struct OutputTarget {
  std::string path;
  int descriptor = -1;  ///< of this process, when the path names one (/dev/stdout, /dev/fd/N)
  bool there = false;
  struct stat status {};  ///< when it is there

  /// Written straight, not replaced.
  bool stream() const { return descriptor >= 0 || (there && !S_ISREG(status.st_mode)); }
  /// The folder of `path`.
  std::string folder() const;
};

/// Throws Error(io) when the links do not end, or end at what takes no bytes (a folder, a socket, a
/// block device), and Error(bad_input) at a file that the command reads.
OutputTarget output_target(const std::string& path);

/// Of a file that the program names itself; see require_own_file().
OutputTarget own_target(const std::string& path);

/// Throws Error(io) where nothing can be put in place: "its folder x cannot be written: Permission
/// denied". `path` is what the user wrote.
void require_writable(const OutputTarget& target, const std::string& path);

/// A descriptor to write to a target that is a stream. Throws Error(io), also for a FIFO without a
/// reader. `path` is what the user wrote.
int open_stream(const OutputTarget& target, const std::string& path);

}  // namespace pbf::inline base_module
