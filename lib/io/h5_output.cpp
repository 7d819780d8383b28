#include "lib/io/h5_output.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace pbf::io_module::h5 {
Properties writer_access() {
  Properties p = file_access();
  check(H5Pset_cache(p, 0, 0, 0, 0));
  // Nodes of indices and collections of texts (4096 bytes) begin with a page of the disk, so that a
  // power cut tears few of them: HDF5 1.14 refuses a collection of which one page is old.
  check(H5Pset_alignment(p, 4096, 4096));
  H5AC_cache_config_t cache;
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  check(H5Pget_mdc_config(p, &cache));
  cache.evictions_enabled = false;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  check(H5Pset_mdc_config(p, &cache));
  return p;
}

void sync(hid_t file) {
  if (::fdatasync(descriptor(file)) != 0) throw Failure(std::strerror(errno));
}

std::int64_t flush_reserved(hid_t file) {
  haddr_t end = 0;
  check(H5Fget_eoa(file, &end));
  const int fd = descriptor(file);
  const off_t size = ::lseek(fd, 0, SEEK_END), wanted = static_cast<off_t>(end);
  if (size < 0) throw Failure(std::strerror(errno));
  if (wanted > size) {
    if (::fallocate(fd, 0, size, wanted - size) != 0 &&
        !(errno == EOPNOTSUPP && ::ftruncate(fd, wanted) == 0))
      throw Failure(std::strerror(errno));
    sync(file);  // HDF5 opens no file that is shorter than its first page says
  }
  check(H5Fflush(file, H5F_SCOPE_GLOBAL));
  return static_cast<std::int64_t>(end);
}

void sync_folder(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;  // not everywhere possible; the files themselves are safe
  ::fsync(fd);
  ::close(fd);
}

void abandon(hid_t file) noexcept {
  try {
    const int fd = descriptor(file);
    int elsewhere = memfd_create("pbf-abandoned", 0);
    if (elsewhere < 0) elsewhere = ::open("/dev/null", O_RDWR);
    if (elsewhere >= 0) {
      dup2(elsewhere, fd);
      ::close(elsewhere);
    }
  } catch (const Failure&) {
    // no descriptor: nothing to turn away
  }
}

}  // namespace pbf::io_module::h5
