#include "lib/base/output_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/output_target.h"

namespace pbf::base_module {
namespace fs = std::filesystem;
namespace {

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
