// Making the neighbor lists, with one or several threads for each.
#pragma once

#include <climits>
#include <cub/util_ptx.cuh>
#include <cub/warp/warp_scan.cuh>

#include "lib/exec/cuda/hit_queue.cuh"
#include "lib/exec/cuda/list_search.cuh"
#include "lib/exec/cuda/transposed_lists.cuh"

namespace pbf::PBF_VARIANT {

/// What the making of lists reports to the host; on the device.
struct ListState {
  int used;     ///< overflows taken in this update
  int wanted;   ///< overflows asked for in any update that had too few
  int longest;  ///< longest list that did not fit, or nearly not, in any update
};

/// A list for the threads that have made it.
struct MadeList {
  int count;             ///< of its entries
  const int4* overflow;  ///< null if it has none
};

/// D, unchanged: see ListSearch.
template <class Real, int D, bool unchanged = true>
struct ListPass : ListSearch<Real, D, unchanged> {
  using Search = ListSearch<Real, D, unchanged>;
  using Search::at, Search::beyond, Search::hits, Search::p, Search::position, Search::row_of,
      Search::rows, Search::scan;
  using Row = typename Search::Row;
  static constexpr int lanes = D == 2 ? 2 : 8;  ///< threads of by_lanes() for one list
  int4 *words, *overflows;
  int *count, *overflow_of;
  ListState* state;
  ListCapacity capacity;
  int stride;
  int far;  ///< the row that pads lists

  /// One thread makes the list of particle i. All threads of a warp take part; valid: i is a
  /// particle.
  template <int block>
  __device__ __forceinline__ void by_thread(int i, bool valid, HitQueue<block> queue) const {
    const Vec<Real, D> xi = point<D>(position[valid ? i : 0]);
    const GridCell c = cell_of<D>(in_space(xi), p);
    int4* out = words + i;
    std::size_t step = std::size_t(stride);
    int written = 0, limit = capacity.first, room = limit;
    const auto write = [&](const int4& word) {
      if (written == room) more_memory(i, out, step, room, limit);
      *out = word;
      out += step;
      ++written;
    };
    int r = 0;
    Row row = row_of(c, valid ? r : rows);
    while (true) {
      while (!__any_sync(kWarp, row.begin < row.end) && ++r < rows)
        row = row_of(c, valid ? r : rows);
      const bool done = r == rows;
      if (!done) {
        const int n = max(min(32, row.end - row.begin), 0);
        const unsigned bits = hits(i, xi, row.begin, n);
        if (bits) queue.push(row.begin, bits);
        row.begin += 32;
      }
      if (!done && !__any_sync(kWarp, queue.full())) continue;
      const int padded = queue.take_words(done, far, write);
      if (!done) continue;
      if (valid) finish(i, 4 * written - padded, limit);
      return;
    }
  }

  /// For few particles: several threads make a list. Each has a few rows of candidates, which it
  /// first counts, then writes in order. All threads of a warp take part; valid: i is a particle.
  template <int of_list = lanes>
  __device__ MadeList by_lanes(int i, int lane, bool valid) const {
    constexpr int most = (rows + of_list - 1) / of_list;
    const bool last = lane == of_list - 1;
    const Vec<Real, D> xi = point<D>(position[valid ? i : 0]);
    const GridCell c = cell_of<D>(in_space(xi), p);
    const int first = lane * rows / of_list, end = (lane + 1) * rows / of_list;
    Row row[most];
    int mine = 0;
#pragma unroll
    for (int r = 0; r < most; ++r) {
      row[r] = row_of(c, valid && first + r < end ? first + r : rows);
      count_row(i, xi, row[r]);
      mine += row[r].found;
    }
    using LaneScan = cub::WarpScan<int, of_list>;
    __shared__ typename LaneScan::TempStorage shared;  // empty: the scan uses shuffles
    int place, all;
    LaneScan(shared).ExclusiveSum(mine, place, all);
    int4* overflow = nullptr;
    if (last && all > 4 * capacity.first) overflow = take_overflow(i);
    overflow = cub::ShuffleIndex<of_list>(overflow, of_list - 1, kWarp);
    const List list{i, overflow};
#pragma unroll
    for (int r = 0; r < most; ++r) place = write_row(i, xi, row[r], place, list);
    const int limit = capacity.first + (overflow ? capacity.overflow : 0);
    if (valid && last) {
      for (int k = all; k & 3; ++k) put(list, k, far);
      finish(i, all, limit);
    }
    return {min(all, 4 * limit), overflow};
  }

  static constexpr int staged = 64;  ///< entries of a list in shared memory

  /// The same for threads that go on with the list: its first entries are also left in `stage`,
  /// shared memory of these threads. Each tests every `of_list`-th candidate of all rows at once.
  template <int of_list>
  __device__ MadeList by_group(int i, int lane, bool valid, int* stage) const {
    const Vec<Real, D> xi = point<D>(position[valid ? i : 0]);
    const GridCell c = cell_of<D>(in_space(xi), p);
    int begin[rows], end[rows], longest = 0;
    unsigned hit_bits[rows] = {};
#pragma unroll
    for (int r = 0; r < rows; ++r) {
      const Row row = row_of(c, valid ? r : rows);
      begin[r] = row.begin + lane, end[r] = row.end;
      longest = max(longest, row.end - row.begin);
    }
    const int rounds = (largest_of_warp(longest) + of_list - 1) / of_list;
    for (int k = 0; k < min(rounds, 32); ++k) {
#pragma unroll
      for (int r = 0; r < rows; ++r) {
        const int j = begin[r] + k * of_list;
        const Vec4<Real> x = at(position + (j < end[r] ? j : far));
        const bool hit = beyond(xi - point<D>(x)) < Real(0) && j != i;
        hit_bits[r] |= unsigned(hit) << k;
      }
    }
    const int group = threadIdx.x % 32 / of_list * of_list;
    int all = 0;
#pragma unroll
    for (int r = 0; r < rows; ++r)
      for (int k = 0; k < min(rounds, 32); ++k) {
        const bool hit = hit_bits[r] >> k & 1;
        const unsigned found = (__ballot_sync(kWarp, hit) >> group) & ((1u << of_list) - 1);
        const int place = all + __popc(found & ((1u << lane) - 1));
        if (hit && place < staged) stage[place] = begin[r] + k * of_list;
        all += __popc(found);
      }
    if (__any_sync(kWarp, all > staged || rounds > 32))
      return by_few<of_list>(i, lane, valid, stage);
    if (lane < (-all & 3)) stage[all + lane] = far;
    int4* overflow = nullptr;
    if (lane == 0 && all > 4 * capacity.first) overflow = take_overflow(i);
    overflow = cub::ShuffleIndex<of_list>(overflow, 0, kWarp);
    __syncwarp();
    const int limit = capacity.first + (overflow ? capacity.overflow : 0);
    for (int k = lane; k < min((all + 3) >> 2, limit); k += of_list)
      *word_of_list(words, stride, capacity.first, overflow, i, k) =
          reinterpret_cast<int4*>(stage)[k];
    if (valid && lane == 0) finish(i, all, limit);
    return {min(all, 4 * limit), overflow};
  }

 private:
  /// by_lanes(), and the first entries in shared memory: for long lists.
  template <int of_list>
  __device__ MadeList by_few(int i, int lane, bool valid, int* stage) const {
    const MadeList list = by_lanes<of_list>(i, lane, valid);
    __syncwarp();
    for (int e = lane; e < min(list.count, staged); e += of_list) {
      const int4* word =
          word_of_list<const int4>(words, stride, capacity.first, list.overflow, i, e >> 2);
      stage[e] = reinterpret_cast<const int*>(word)[e & 3];
    }
    return list;
  }
  /// For a word behind the first `room`, which is all that there was memory for. limit: words of
  /// the list. If there is no more memory, its next words overwrite the first one: the batch is
  /// repeated with more.
  __device__ __forceinline__ void more_memory(int i, int4*& out, std::size_t& step, int& room,
                                              int& limit) const {
    int4* block = limit == capacity.first ? take_overflow(i) : nullptr;
    limit += block ? capacity.overflow : 0;
    room = block ? limit : INT_MAX;
    out = block ? block : words + i;
    step = block ? 1 : 0;
  }
  __device__ __forceinline__ void count_row(int i, Vec<Real, D> xi, Row& r) const {
    scan(i, xi, r.begin, r.end, [&](int, unsigned bits) {
      r.found += __popc(bits);
      r.bits = bits;
    });
  }
  /// The list of particle i; overflow is null if it needs none or none is left.
  struct List {
    int i;
    int4* overflow;
  };
  __device__ __forceinline__ int write_bits(int first, unsigned bits, int place,
                                            const List& list) const {
    while (bits) {
      const int k = __clz(int(bits));
      bits &= ~(0x80000000u >> k);
      put(list, place++, first + k);
    }
    return place;
  }
  __device__ __forceinline__ int write_row(int i, Vec<Real, D> xi, const Row& r, int place,
                                           const List& list) const {
    if (r.end - r.begin <= 32) return write_bits(r.begin, r.bits, place, list);
    scan(i, xi, r.begin, r.end,
         [&](int first, unsigned bits) { place = write_bits(first, bits, place, list); });
    return place;
  }
  __device__ __forceinline__ void put(const List& list, int at, int j) const {
    const int k = at >> 2, limit = capacity.first + (list.overflow ? capacity.overflow : 0);
    if (k >= limit) return;
    int4* word = word_of_list(words, stride, capacity.first, list.overflow, list.i, k);
    reinterpret_cast<int*>(word)[at & 3] = j;
  }
  /// Null when there is none left.
  __device__ __forceinline__ int4* take_overflow(int i) const {
    const int mine = atomicAdd(&state->used, 1);
    if (mine >= capacity.overflows) {
      atomicMax(&state->wanted, mine + 1);
      return nullptr;
    }
    overflow_of[i] = mine;
    return overflows + std::size_t(mine) * capacity.overflow;
  }
  /// limit: words that fit.
  __device__ __forceinline__ void finish(int i, int all, int limit) const {
    count[i] = min(all, 4 * limit);
    if (all > capacity.nearly_longest()) atomicMax(&state->longest, all);
  }
};

}  // namespace pbf::PBF_VARIANT
