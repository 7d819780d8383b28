#include "lib/base/output_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/inputs.h"
#include "lib/base/own_file.h"
#include "lib/base/regular_file.h"

namespace pbf::base_module {
namespace fs = std::filesystem;
namespace {

/// The end of all links of a path. It need not exist yet.
struct OutputTarget {
  std::string path;
  int descriptor = -1;  ///< of this process, when the path names one (/dev/stdout, /dev/fd/N)
  bool there = false;
  struct stat status {};  ///< when it is there

  /// Whether it is written directly instead of being replaced.
  bool stream() const { return descriptor >= 0 || (there && !S_ISREG(status.st_mode)); }
  std::string folder() const {
    const fs::path parent = fs::path(path).parent_path();
    return parent.empty() ? "." : parent.string();
  }
};

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

/// For a path that the user gave. Throws Error(io) if the links form a loop or lead to a folder, a
/// socket or a block device, and Error(bad_input) for a file that the command reads.
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

/// For a file that the program names itself; see require_own_file().
OutputTarget own_target(const std::string& path) {
  require_own_file(path);
  OutputTarget t;
  t.path = path;
  t.there = ::lstat(path.c_str(), &t.status) == 0;
  return t;
}

/// Throws Error(io) if the file cannot be created or replaced: "its folder x cannot be written:
/// Permission denied". `path`, as the user wrote it, begins the message.
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

/// Opens a target that is a stream for writing. Throws Error(io), also for a FIFO without a reader.
/// `path`, as the user wrote it, begins the message.
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

/// A random name, which is never too long.
std::string temporary_name(const std::string& folder) {
  static thread_local std::random_device random;
  return fmt::format("{}/{}{:08x}", folder, kTemporaryPrefix, random());
}

}  // namespace

OutputFile::OutputFile(const std::string& path, Naming naming) : path_(path) {
  const OutputTarget t = naming == Naming::own ? own_target(path) : output_target(path);
  if (t.stream()) {
    fd_ = open_stream(t, path);
    straight_ = true;
    return;
  }
  target_ = t.path;
  folder_ = t.folder();
  require_writable(t, path);
  // A file without a name vanishes however the program ends. Not every file system supports it.
  if (::access("/proc/self/fd", X_OK) == 0)
    fd_ = ::open(folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  nameless_ = fd_ >= 0;
  for (int attempt = 0; fd_ < 0 && attempt < 100; ++attempt) {
    temporary_ = temporary_name(folder_);
    fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ >= 0 || errno == EEXIST) continue;
    temporary_.clear();
    fail("create the file", errno);
  }
  if (fd_ < 0) fail("create the file", EEXIST);
  if (t.there) ::fchmod(fd_, t.status.st_mode & 0777);  // keeps the permissions
}

OutputFile::~OutputFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::fail(const std::string& what, int reason) {
  throw Error(ExitCode::io, path_ + ": cannot " + what + ": " + std::strerror(reason));
}

void OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(n));
    } else if (errno == EAGAIN) {  // an inherited non-blocking descriptor, full for now
      pollfd ready{fd_, POLLOUT, 0};
      ::poll(&ready, 1, -1);
    } else if (straight_ && errno == EPIPE) {
      return;
    } else if (errno != EINTR) {
      fail("write the file", errno);
    }
  }
}

void OutputFile::give_name() {
  const std::string self = fmt::format("/proc/self/fd/{}", fd_);
  for (int attempt = 0; attempt < 100; ++attempt) {
    const std::string name = temporary_name(folder_);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      temporary_ = name;
      return;
    }
    if (errno != EEXIST) break;
  }
  fail("create the file", errno);
}

void OutputFile::finish(bool stored) {
  // EINVAL: this kind of file cannot be synchronized.
  if (stored && !straight_ && ::fsync(fd_) != 0 && errno != EINVAL) fail("write the file", errno);
  if (nameless_) give_name();
  if (::close(std::exchange(fd_, -1)) != 0) fail("write the file", errno);
  if (straight_) return;
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
    fail("move the file into place", errno);
  temporary_.clear();
}

void write_text_file(const std::string& path, const std::string& text, Naming naming) {
  OutputFile file(path, naming);
  file.write(text);
  file.finish(true);
}

int open_output_stream(const std::string& path, bool append) {
  const OutputTarget t = output_target(path);
  if (t.stream()) return open_stream(t, path);
  const int how = O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | O_APPEND;
  const int fd = ::open(t.path.c_str(), append ? how : how | O_TRUNC, 0666);
  if (fd < 0) throw Error(ExitCode::io, path + ": cannot be created: " + std::strerror(errno));
  return fd;
}

bool is_stream(const std::string& path) { return output_target(path).stream(); }

void check_output(const std::string& option, const std::string& path) {
  if (path.empty()) return;
  try {
    const OutputTarget t = output_target(path);
    if (!t.stream()) require_writable(t, path);
  } catch (const Error& e) {
    throw Error(e.code(), option + " " + e.what());
  }
}

bool same_output(const std::string& a, const std::string& b) {
  const auto place = [](const std::string& path) {
    const OutputTarget t = output_target(path);
    std::error_code error;
    return fs::weakly_canonical(fs::absolute(t.path), error);
  };
  return !is_stream(a) && !is_stream(b) && place(a) == place(b);
}

void check_outputs(const std::string& option, const std::string& path, const std::string& other,
                   const std::string& other_path) {
  check_output(option, path);
  check_output(other, other_path);
  if (!path.empty() && !other_path.empty() && same_output(path, other_path))
    throw Error(ExitCode::bad_input, option + " and " + other + " name one file: " + path);
}

}  // namespace pbf::base_module
