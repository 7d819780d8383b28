// Opens files that must be regular: a pipe would wait for its writer, a device may never end.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace pbf::inline base_module {

/// "a link", "a FIFO", "a folder" ..., from st_mode.
std::string file_kind(mode_t mode);

/// The kind of what a path leads to, without opening it; empty for a regular file and for what is
/// not there or cannot be looked at.
std::string not_regular(const std::string& path);

/// A regular file open for reading.
class RegularFile {
 public:
  /// Error(io) when it cannot be opened or is no regular file; `expected` says what was ("a
  /// particle file"), `missing` is added where the file is not there.
  RegularFile(const std::string& path, const std::string& expected, const std::string& missing);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;
  /// The next bytes, `size` at most; 0 at the end. Error(io).
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

}  // namespace pbf::inline base_module
