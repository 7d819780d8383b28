// Constants for the sizes of arrays on the device; this header needs no CUDA header.
#pragma once

#include <algorithm>
#include <cstdint>

namespace pbf::inline program_module {

/// Capacity of the neighbour lists on the device, in words of 4 entries.
struct ListCapacity {
  int first = 0;      ///< words every list has
  int overflow = 0;   ///< words of one overflow block
  int overflows = 0;  ///< overflow blocks in the pool
  constexpr int longest() const { return 4 * (first + overflow); }
};

/// Capacity at first for lists that hold `rest_neighbors` at rest: a seventh more for all, and an
/// eighth of the lists may be up to 32 entries longer. first_entries > 0: that many for all
/// instead.
inline ListCapacity first_list_capacity(double rest_neighbors, std::int64_t n,
                                        int first_entries = 0) {
  const int first = first_entries > 0 ? first_entries : int(rest_neighbors * 1.15);
  return {(first + 3) / 4, 8, int(n / 8) + 32};
}

/// More of it, with air for what may come, where `overflows` lists outgrew the first words and the
/// longest holds `longest` entries (0: none is too long): longer lists for all while many outgrow
/// theirs, or more overflow blocks; and longer ones, but then no more of them than are in use, for
/// one very long list (a clump of thousands of particles) must not cost every block its length.
inline ListCapacity larger_list_capacity(ListCapacity capacity, std::int64_t overflows, int longest,
                                         std::int64_t n) {
  if (overflows > n / 8 + 32 && capacity.first < 96) {
    capacity.first += (capacity.first + 1) / 2;
    return capacity;
  }
  if (longest > capacity.longest())
    capacity.overflow = (longest + longest / 8) / 4 + 1 - capacity.first;
  capacity.overflows = int(std::min<std::int64_t>(overflows + overflows / 4 + 32, 2147483647));
  return capacity;
}

/// Words between word k and k + 1 of one particle: whole warps.
constexpr int list_stride(int n) { return (n + 31) / 32 * 32; }

/// Blocks of 128 threads that share a measure's sums.
constexpr int reduce_blocks(std::int64_t n) { return int(n < 65536 ? (n + 127) / 128 : 512); }

/// Up to so many particles and bins one block sorts them. The counters and a scan over the threads
/// share 48 KiB of memory, which every device has.
constexpr int kSortThreads = 1024, kSortParticles = 3000, kSortBins = 12 * 1024 - 64;

}  // namespace pbf::inline program_module
