#include "lib/base/part_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

#include "lib/base/error.h"
#include "lib/base/stage_clock.h"

namespace pbf::base_module {

std::uint64_t inode_of(const std::string& path) {
  struct stat s {};
  return ::stat(path.c_str(), &s) == 0 && ::access(path.c_str(), W_OK) == 0 ? s.st_ino : 0;
}

namespace {

int open_folder(const std::string& path) {
  return ::open(path.empty() ? "." : path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

}  // namespace

bool wait_for_parts(const std::string& folder, double seconds) {
  const int fd = open_folder(folder);
  if (fd < 0) return true;
  const Stopwatch since;
  bool busy = false;
  while ((busy = ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) &&
         since.seconds() < seconds)
    ::usleep(10000);
  ::close(fd);
  return !busy;
}

PartFile::PartFile(const std::string& path) : path_(path) {
  folder_ = open_folder(std::filesystem::path(path).parent_path().string());
  if (folder_ >= 0) ::flock(folder_, LOCK_SH | LOCK_NB);  // where there are such locks
  file_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file_ < 0) {
    const int reason = errno;
    if (folder_ >= 0) ::close(folder_);
    errno = reason;
    fail();
  }
  worker_ = std::make_unique<Worker>(std::numeric_limits<int>::max());
}
PartFile::~PartFile() {
  worker_.reset();
  if (file_ >= 0) ::close(file_);
  if (folder_ >= 0) ::close(folder_);
}

void PartFile::write(std::vector<Part> parts, std::shared_ptr<const void> owner) {
  if (parts.empty()) return;
  ++queued_;
  worker_->push(
      [this, all = std::move(parts), owner = std::move(owner)] {
        store(all);
        --queued_;
      },
      false);
}

bool PartFile::done(bool wait) {
  if (wait) worker_->wait();
  if (const std::exception_ptr failure = worker_->failure()) std::rethrow_exception(failure);
  return queued_ == 0;
}

void PartFile::store(const std::vector<Part>& parts) const {
  for (const Part& p : parts)
    for (std::size_t done = 0; done < p.bytes.size();) {
      const ssize_t n = ::pwrite(file_, p.bytes.data() + done, p.bytes.size() - done,
                                 static_cast<off_t>(p.at + done));
      if (n < 0 && errno != EINTR) fail();
      if (n > 0) done += std::size_t(n);
    }
  if (::fdatasync(file_) != 0) fail();
}

void PartFile::fail() const {
  throw Error(ExitCode::io, path_ + ": cannot write this rank's part of a frame: " +
                                std::strerror(errno) + "; the frames before it are kept");
}

}  // namespace pbf::base_module
