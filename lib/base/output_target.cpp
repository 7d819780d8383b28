#include "lib/base/output_target.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/own_file.h"
#include "lib/base/regular_file.h"

namespace pbf::base_module {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw Error(ExitCode::io, path + ": " + what);
}

/// N if the link is /proc/self/fd/N under any name; -1 for any other link.
int own_descriptor(const fs::path& link) {
  std::error_code error;
  const fs::path folder = fs::canonical(link.parent_path(), error);
  if (error || folder != fs::canonical("/proc/self/fd", error)) return -1;
  const std::string name = link.filename().string();
  int number = -1;
  std::from_chars(name.data(), name.data() + name.size(), number);
  return number;
}

OutputTarget follow(const std::string& path) {
  constexpr int kMostLinks = 40;  // the limit of Linux
  OutputTarget t;
  t.path = path;
  for (int links = 0; links <= kMostLinks; ++links) {
    t.there = ::lstat(t.path.c_str(), &t.status) == 0;
    if (!t.there && errno != ENOENT)
      fail(path, std::string("cannot be written: ") + strerror(errno));
    if (!t.there || !S_ISLNK(t.status.st_mode)) return t;
    t.descriptor = own_descriptor(t.path);
    if (t.descriptor >= 0) {
      t.there = ::fstat(t.descriptor, &t.status) == 0;
      return t;
    }
    // The text of a link in /proc need not be a path: "pipe:[7]".
    struct stat end {};
    if (::stat(t.path.c_str(), &end) == 0 && !S_ISREG(end.st_mode)) {
      t.status = end;
      return t;
    }
    std::error_code error;
    t.path = (fs::path(t.path).parent_path() / fs::read_symlink(t.path, error)).string();
    if (error) fail(path, "the link cannot be followed: " + error.message());
  }
  fail(path, "the link leads to itself");
}

}  // namespace

std::string OutputTarget::folder() const {
  const fs::path parent = fs::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

OutputTarget output_target(const std::string& path) {
  OutputTarget t = follow(path);
  if (const std::string input = input_at(path); !input.empty())
    throw Error(ExitCode::bad_input,
                path + ": is the same file as " + input +
                    ", which this command reads and would overwrite; give another name");
  if (t.descriptor >= 0 && !t.there)
    fail(path, "descriptor " + std::to_string(t.descriptor) + " is not open");
  if (!t.there) return t;
  const mode_t mode = t.status.st_mode;
  if (S_ISDIR(mode) || S_ISBLK(mode) || (S_ISSOCK(mode) && t.descriptor < 0))
    fail(path, "cannot be written: is " + file_kind(mode) + ", expected a file, a pipe or a FIFO");
  return t;
}

OutputTarget own_target(const std::string& path) {
  require_own_file(path);
  OutputTarget t;
  t.path = path;
  t.there = ::lstat(path.c_str(), &t.status) == 0;
  return t;
}

void require_writable(const OutputTarget& t, const std::string& path) {
  const auto writable = [](const std::string& place, int how) {
    return ::faccessat(AT_FDCWD, place.c_str(), how, AT_EACCESS) == 0;
  };
  if (!writable(t.folder(), W_OK | X_OK)) {
    const int reason = errno;
    fail(path, "its folder " + t.folder() + " cannot be written: " + std::strerror(reason));
  }
  if (t.there && !writable(t.path, W_OK))
    fail(path, std::string("it cannot be replaced: ") + std::strerror(errno));
}

int open_stream(const OutputTarget& target, const std::string& path) {
  // O_NONBLOCK, because open() would wait for the reader of a FIFO. It is cleared below for writes.
  const int fd = target.descriptor >= 0
                     ? ::fcntl(target.descriptor, F_DUPFD_CLOEXEC, 0)
                     : ::open(target.path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (fd < 0 && errno == ENXIO && S_ISFIFO(target.status.st_mode))
    fail(path, "is a FIFO that nobody reads; start its reader first");
  if (fd < 0) fail(path, std::string("cannot be written: ") + std::strerror(errno));
  if (target.descriptor < 0) ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) & ~O_NONBLOCK);
  return fd;
}

}  // namespace pbf::base_module
