// HDF5 and the writer call the C library's pwrite, ftruncate, fallocate and fdatasync; definitions
// in the program come first.
#include "tests/support/run_file_disk.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "tests/support/run_file_samples.h"
#include "tests/support/split_frame.h"

namespace {

struct Watch {
  std::mutex mutex;
  bool active = false, record = true;
  std::string path;
  std::int64_t capacity = 0, refused = 0;
  std::vector<pbf::test::DiskOperation> operations;
} watch;

bool watched(int fd) {  // under the mutex
  if (!watch.active) return false;
  struct stat here, there;
  return fstat(fd, &here) == 0 && stat(watch.path.c_str(), &there) == 0 &&
         here.st_ino == there.st_ino && here.st_dev == there.st_dev;
}

ssize_t watched_write(int fd, const void* data, size_t size, off_t offset) {
  {
    const std::lock_guard lock(watch.mutex);
    if (watched(fd)) {
      struct stat now;
      fstat(fd, &now);
      const auto end = static_cast<std::int64_t>(offset) + static_cast<std::int64_t>(size);
      if (end > now.st_size && end > watch.capacity) {
        ++watch.refused;
        errno = ENOSPC;
        return -1;
      }
      if (watch.record) {
        const auto* bytes = static_cast<const std::byte*>(data);
        watch.operations.push_back(
            {pbf::test::DiskOperation::write, offset, {bytes, bytes + size}});
      }
    }
  }
  return syscall(SYS_pwrite64, fd, data, size, offset);
}

int watched_reserve(int fd, int mode, off_t offset, off_t size) {
  {
    const std::lock_guard lock(watch.mutex);
    if (watched(fd)) {
      if (offset + size > watch.capacity) {
        ++watch.refused;
        errno = ENOSPC;
        return -1;
      }
      if (watch.record)
        watch.operations.push_back({pbf::test::DiskOperation::resize, offset + size, {}});
    }
  }
  return static_cast<int>(syscall(SYS_fallocate, fd, mode, offset, size));
}

int watched_resize(int fd, off_t size) {
  {
    const std::lock_guard lock(watch.mutex);
    if (watched(fd) && watch.record)
      watch.operations.push_back({pbf::test::DiskOperation::resize, size, {}});
  }
  return static_cast<int>(syscall(SYS_ftruncate, fd, size));
}

int watched_sync(int number, int fd) {
  const auto result = static_cast<int>(syscall(number, fd));
  const std::lock_guard lock(watch.mutex);
  if (result == 0 && watched(fd) && watch.record)
    watch.operations.push_back({pbf::test::DiskOperation::barrier, 0, {}});
  return result;
}

}  // namespace

extern "C" {
// The prototypes of <unistd.h> carry attributes that differ between C libraries.
ssize_t pwrite(int fd, const void* data, size_t size, off_t offset) {
  return watched_write(fd, data, size, offset);
}
ssize_t pwrite64(int fd, const void* data, size_t size, off64_t offset) {
  return watched_write(fd, data, size, offset);
}
int fallocate(int fd, int mode, off_t offset, off_t size) {
  return watched_reserve(fd, mode, offset, size);
}
int fsync(int fd) { return watched_sync(SYS_fsync, fd); }
int fdatasync(int fd) { return watched_sync(SYS_fdatasync, fd); }
int ftruncate(int fd, off_t size) noexcept { return watched_resize(fd, size); }
int ftruncate64(int fd, off64_t size) noexcept { return watched_resize(fd, size); }
}

namespace pbf::test {

WatchedDisk::WatchedDisk(const std::string& path, std::int64_t capacity, bool record) {
  const std::lock_guard lock(watch.mutex);
  if (watch.active) std::abort();
  watch.active = true;
  watch.record = record;
  watch.path = path;
  watch.capacity = capacity;
  watch.refused = 0;
  watch.operations.clear();
}

WatchedDisk::~WatchedDisk() {
  const std::lock_guard lock(watch.mutex);
  watch.active = false;
  watch.operations.clear();
}

void WatchedDisk::mark(std::int64_t number) {
  const std::lock_guard lock(watch.mutex);
  watch.operations.push_back({DiskOperation::mark, number, {}});
}

std::vector<DiskOperation> WatchedDisk::operations() const {
  const std::lock_guard lock(watch.mutex);
  return watch.operations;
}

std::vector<DiskOperation> operations_of_a_run(const std::string& path, std::int64_t frames,
                                               bool gzip, bool split) {
  WatchedDisk disk(path);
  RunWriter writer(path, split ? sample_info(kSplitRows) : changing_info(), gzip);
  disk.mark(0);
  for (std::int64_t k = 0; k < frames; ++k) {
    for (int row = 0; row < 10; ++row) writer.log(sample_row(10 * k + row));
    if (split)
      write_split(writer, path, split_sample(k), 3);
    else
      writer.write(changing_sample(k));
    if (!split && k % 6 != 0 && k % 6 != 2 && k % 6 != 5) continue;  // committed in groups
    writer.sync();
    disk.mark(k + 1);
  }
  writer.finish({"finished"});
  return disk.operations();
}

std::int64_t WatchedDisk::refused() const {
  const std::lock_guard lock(watch.mutex);
  return watch.refused;
}

}  // namespace pbf::test
