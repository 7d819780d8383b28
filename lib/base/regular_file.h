// Opens files that must be regular: a pipe would block until it is written, a device may never end.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace pbf::base_module {

/// "a link", "a FIFO", "a folder" ..., from st_mode.
std::string file_kind(mode_t mode);

/// The kind of the file at the end of a path's links; empty for a regular file, a missing one and
/// one without permission.
std::string not_regular(const std::string& path);

/// A regular file open for reading.
class RegularFile {
 public:
  /// Throws Error(io) if it cannot be opened or is no regular file. `expected` ("a particle file")
  /// is part of the message; `missing` is added to it if the file does not exist.
  RegularFile(const std::string& path, const std::string& expected, const std::string& missing);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;
  /// Reads at most `size` bytes and returns their number; 0 at the end. Throws Error(io).
  std::size_t read(char* bytes, std::size_t size);
  /// Size in bytes and time of the last change in ns, of this file whatever its path leads to now.
  /// Error(io).
  std::pair<std::size_t, std::int64_t> stamp() const;
  /// Back to the first byte.
  void rewind();

 private:
  std::string path_;
  int fd_ = -1;
};

}  // namespace pbf::base_module
