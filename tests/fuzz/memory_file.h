// The bytes of a fuzzer as a file that has a path. HDF5 asks for the real path, which
// memfd_create() does not give, so it lies in /dev/shm.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace pbf::test {

class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size)
      : path_("/dev/shm/pbf_fuzz_" + std::to_string(getpid())) {
    const int fd = open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0600);
    if (fd < 0 || write(fd, data, size) != static_cast<ssize_t>(size)) std::abort();
    const timespec long_ago[2] = {{0, 0}, {0, 0}};
    futimens(fd, long_ago);  // nobody is writing it
    close(fd);
  }
  ~MemoryFile() { unlink(path_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace pbf::test
