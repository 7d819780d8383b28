// Constants for the sizes of arrays on the device; this header needs no CUDA header.
#pragma once

#include <algorithm>
#include <cstdint>

namespace pbf::program_module {

/// Capacity of the neighbor lists on the device, in words of 4 entries.
struct ListCapacity {
  int first = 0;      ///< words of every list
  int overflow = 0;   ///< words of one overflow block
  int overflows = 0;  ///< overflow blocks in the pool
  constexpr int longest() const { return 4 * (first + overflow); }
  /// Lists longer than this, or more overflows, need more memory soon.
  constexpr int nearly_longest() const { return longest() - longest() / 16; }
  constexpr int nearly_overflows() const { return overflows - overflows / 8; }
};

/// What lists on the device lacked.
struct ListDemand {
  std::int64_t overflows = 0;  ///< blocks; 0: there were enough
  std::int64_t longest = 0;    ///< entries of the longest list; 0: all were short enough
  constexpr bool any() const { return overflows > 0 || longest > 0; }
};

/// Initial capacity: every list has 1.15 times the entries of fluid at rest (`rest_neighbors`), or
/// `first_entries` if that is above 0. One list in eight may have up to 32 more.
inline ListCapacity first_list_capacity(double rest_neighbors, std::int64_t n,
                                        int first_entries = 0) {
  const int first = first_entries > 0 ? first_entries : int(rest_neighbors * 1.15);
  return {(first + 3) / 4, 8, int(n / 8) + 32};
}

/// A larger capacity with some reserve, after `overflows` lists outgrew their first words and the
/// longest one has `longest` entries (0: none is too long, or nearly). If many lists overflow, all
/// become longer. Otherwise there are more overflow blocks, and longer ones if needed. Their number
/// follows `overflows`, because one very long list (a dense clump) determines the length of every
/// block.
inline ListCapacity larger_list_capacity(ListCapacity capacity, std::int64_t overflows, int longest,
                                         std::int64_t n) {
  if (overflows > n / 8 + 32 && capacity.first < 96) {
    capacity.first += (capacity.first + 1) / 2;
    return capacity;
  }
  if (longest > 0)
    capacity.overflow =
        std::max(capacity.overflow, (longest + longest / 8) / 4 + 1 - capacity.first);
  capacity.overflows = int(std::min<std::int64_t>(overflows + overflows / 4 + 32, 2147483647));
  return capacity;
}

/// Distance from word k to word k + 1 of a list, in words: n rounded up to whole warps.
constexpr int list_stride(int n) { return (n + 31) / 32 * 32; }

/// Number of blocks (128 threads each) in the sums of a measurement.
constexpr int reduce_blocks(std::int64_t n) { return int(n < 65536 ? (n + 127) / 128 : 512); }

/// A single block sorts up to this many particles and bins. Its counters and ids fit in 48 KiB of
/// shared memory, which every device has. From 1500 particles on, several kernels are faster.
constexpr int kSortThreads = 1024, kSortParticles = 1500,
              kSortBins = 12 * 1024 - 65 - kSortParticles;

}  // namespace pbf::program_module
