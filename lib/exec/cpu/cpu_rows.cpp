#include "lib/exec/cpu/cpu_rows.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace pbf::PBF_VARIANT {

void CpuRows::clear_pages(char* at, std::size_t bytes) {
  const auto page = std::uintptr_t(sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(at), end = begin + bytes;
  const std::uintptr_t first = (begin + page - 1) / page * page, last = end / page * page;
  if (last <= first || madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED) != 0)
    return clear(at, bytes);
  clear(at, first - begin);
  clear(reinterpret_cast<char*>(last), end - last);
}

}  // namespace pbf::PBF_VARIANT
