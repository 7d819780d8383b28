#include "lib/base/own_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/regular_file.h"

namespace pbf::base_module {
namespace {

[[noreturn]] void refuse_own(const std::string& path, mode_t mode) {
  std::string what = file_kind(mode);
  std::error_code error;
  if (S_ISLNK(mode)) what += " to " + std::filesystem::read_symlink(path, error).string();
  throw Error(ExitCode::io, path + ": is " + what +
                                ", and in a folder of results only regular files are read and "
                                "written; remove it, or give another folder with --out");
}

}  // namespace

void require_own_file(const std::string& path) {
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode))
    refuse_own(path, there.st_mode);
}

int open_own_file(const std::string& path, int flags) {
  // Without O_NONBLOCK, open() would wait for the reader of a FIFO.
  const int fd = ::open(path.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | O_NOCTTY, 0666);
  if (fd < 0) {
    const int reason = errno;
    require_own_file(path);
    throw Error(ExitCode::io, path + ": cannot be created: " + std::strerror(reason));
  }
  struct stat there {};
  if (::fstat(fd, &there) != 0 || S_ISREG(there.st_mode)) return fd;
  ::close(fd);
  refuse_own(path, there.st_mode);
}

}  // namespace pbf::base_module
