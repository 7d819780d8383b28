// What decides the size of arrays on the device; no CUDA header is needed to include this.
#pragma once

#include <algorithm>
#include <cstdint>

namespace pbf::inline program_module {

/// How much room the neighbour lists on the device have, in words of 4 entries.
struct ListRoom {
  int first = 0;  ///< words every list has
  int tail = 0;   ///< words of one tail
  int tails = 0;  ///< tails in the pool
  constexpr int longest() const { return 4 * (first + tail); }
};

/// Room at first for lists that hold `rest_neighbors` at rest: a seventh more for all, and an
/// eighth of the lists may be up to 32 entries longer. first_entries > 0: that many for all
/// instead.
inline ListRoom first_list_room(double rest_neighbors, std::int64_t n, int first_entries = 0) {
  const int first = first_entries > 0 ? first_entries : int(rest_neighbors * 1.15);
  return {(first + 3) / 4, 8, int(n / 8) + 32};
}

/// More room, with air for what may come, where `tails` lists outgrew the first room and the
/// longest holds `longest` entries (0: none is too long): longer lists for all while many outgrow
/// theirs, or more tails; and longer ones, but then no more of them than are in use, for one very
/// long list (a clump of thousands of particles) must not cost every tail its length.
inline ListRoom larger_list_room(ListRoom room, std::int64_t tails, int longest, std::int64_t n) {
  if (tails > n / 8 + 32 && room.first < 96) {
    room.first += (room.first + 1) / 2;
    return room;
  }
  if (longest > room.longest()) room.tail = (longest + longest / 8) / 4 + 1 - room.first;
  room.tails = int(std::min<std::int64_t>(tails + tails / 4 + 32, 2147483647));
  return room;
}

/// Words between word k and k + 1 of one particle: whole warps.
constexpr int list_stride(int n) { return (n + 31) / 32 * 32; }

/// Blocks of 128 threads that share a measure's sums.
constexpr int reduce_blocks(std::int64_t n) { return int(n < 65536 ? (n + 127) / 128 : 512); }

/// Up to so many particles and bins one block sorts them, with the counters in 48 KiB of shared
/// memory, which every device has.
constexpr int kSortThreads = 1024, kSortParticles = 3000, kSortBins = 12 * 1024;

}  // namespace pbf::inline program_module
