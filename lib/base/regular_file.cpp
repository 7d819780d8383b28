#include "lib/base/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "lib/base/error.h"

namespace pbf::base_module {
std::string file_kind(mode_t mode) {
  if (S_ISREG(mode)) return "a regular file";
  if (S_ISLNK(mode)) return "a link";
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a FIFO";
  if (S_ISSOCK(mode)) return "a socket";
  return S_ISBLK(mode) ? "a block device" : "a device";
}

std::string not_regular(const std::string& path) {
  struct stat there {};
  if (::stat(path.c_str(), &there) != 0 || S_ISREG(there.st_mode)) return {};
  return file_kind(there.st_mode);
}

RegularFile::RegularFile(const std::string& path, const std::string& expected,
                         const std::string& missing)
    : path_(path) {
  const auto refuse = [&](const std::string& kind) {
    if (!kind.empty())
      throw Error(ExitCode::io,
                  path + ": is " + kind + ", expected " + expected + "; give a regular file");
  };
  refuse(not_regular(path));
  // O_NONBLOCK: the file may have been replaced by a pipe meanwhile, and open() must not wait.
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd_ < 0) {
    const int reason = errno;
    throw Error(ExitCode::io, path + ": cannot be opened: " + std::strerror(reason) +
                                  (reason == ENOENT ? missing : std::string()));
  }
  struct stat state {};
  if (::fstat(fd_, &state) != 0 || S_ISREG(state.st_mode)) return;
  ::close(fd_);
  refuse(file_kind(state.st_mode));
}

RegularFile::~RegularFile() { ::close(fd_); }

std::size_t RegularFile::read(char* bytes, std::size_t size) {
  ssize_t n = 0;
  do n = ::read(fd_, bytes, size);
  while (n < 0 && errno == EINTR);
  if (n < 0) throw Error(ExitCode::io, path_ + ": reading failed: " + std::strerror(errno));
  return static_cast<std::size_t>(n);
}

std::pair<std::size_t, std::int64_t> RegularFile::stamp() const {
  struct stat state {};
  if (::fstat(fd_, &state) != 0)
    throw Error(ExitCode::io, path_ + ": reading failed: " + std::strerror(errno));
  return {state.st_size, state.st_mtim.tv_sec * std::int64_t{1000000000} + state.st_mtim.tv_nsec};
}

void RegularFile::rewind() {
  if (::lseek(fd_, 0, SEEK_SET) < 0)
    throw Error(ExitCode::io, path_ + ": reading failed: " + std::strerror(errno));
}

}  // namespace pbf::base_module
