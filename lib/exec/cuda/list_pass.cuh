// Making the neighbor lists: exact, without a branch per candidate. The hits of up to 32
// candidates are collected as bits, then taken out in order.
#pragma once

#include <cub/util_ptx.cuh>
#include <cub/warp/warp_scan.cuh>

#include "lib/exec/cuda/transposed_lists.cuh"

namespace pbf::PBF_VARIANT {

/// Shifts `mask` left by one place and puts the sign bit of x into its lowest bit.
__device__ __forceinline__ unsigned push_sign(float x, unsigned mask) {
  return __funnelshift_l(__float_as_uint(x), mask, 1);
}
__device__ __forceinline__ unsigned push_sign(double x, unsigned mask) {
  return __funnelshift_l(unsigned(__double2hiint(x)), mask, 1);
}

/// What the making of lists reports to the host; on the device.
struct ListState {
  int used;     ///< overflows taken in this update
  int wanted;   ///< overflows asked for in any update that had too few
  int longest;  ///< longest list that did not fit, or nearly not, in any update
};

/// D: dimensions of the scene.
template <class Real, int D>
struct ListPass {
  static constexpr int rows = D == 2 ? 3 : 9;   ///< of cells around a cell
  static constexpr int lanes = D == 2 ? 2 : 8;  ///< threads of by_lanes() for one list
  Params<Real> p;
  const Vec4<Real>* position;
  const int* bin_start;
  int4 *words, *overflows;
  int *count, *overflow_of;
  ListState* state;
  ListCapacity capacity;
  int stride;
  int far;  ///< the row that pads lists

  /// hits(first, bits): bit 31 - k set where candidate first + k is a neighbor of i.
  template <class F>
  __device__ __forceinline__ void scan(int i, Vec<Real, D> xi, int begin, int end, F&& hits) const {
    for (int first = begin; first < end; first += 32) {
      const int n = min(32, end - first);
      unsigned bits = 0;
#pragma unroll 4
      for (int k = 0; k < n; ++k) {
        const Vec<Real, D> d = xi - point<D>(load(position, first + k));
        bits = push_sign(dot(d, d) - Real(1), bits);
      }
      bits <<= 32 - n;  // the first candidate at bit 31
      if (unsigned(i - first) < unsigned(n)) bits &= ~(0x80000000u >> (i - first));
      hits(first, bits);
    }
  }

  /// One thread makes the list of particle i, packing four entries in registers for each write.
  __device__ void operator()(int i) const {
    const Vec<Real, D> xi = point<D>(position[i]);
    int4* out = words + i;
    std::size_t step = std::size_t(stride);
    int4 word{0, 0, 0, 0};
    int found = 0, limit = capacity.first + capacity.overflow;
    const auto put = [&](int j) {
      word = {word.y, word.z, word.w, j};
      if (++found & 3) return;
      const int k = (found >> 2) - 1;
      if (k == capacity.first) {
        out = take_overflow(i);
        step = 1;
        if (!out) limit = k;
      }
      if (k >= limit) return;
      *out = word;
      out += step;
    };
    for_each_run<D>(in_space(xi), bin_start, p, [&](int begin, int end) {
      scan(i, xi, begin, end, [&](int first, unsigned bits) {
        while (bits) {
          const int k = __clz(int(bits));
          bits &= ~(0x80000000u >> k);
          put(first + k);
        }
      });
    });
    const int all = found;
    while (found & 3) put(far);  // the far particle
    finish(i, all, limit);
  }

  /// For few particles: eight threads make a list (two in two dimensions). Each has a row of
  /// candidates (the last one two rows), which it first counts, then writes in order.
  __device__ void by_lanes(int thread, int n) const {
    const int i = thread / lanes, lane = thread % lanes;
    const bool valid = i < n;
    const bool last = lane == lanes - 1;
    const Vec<Real, D> xi = point<D>(position[valid ? i : 0]);
    const GridCell c = cell_of<D>(in_space(xi), p);
    Row a = row_of(c, valid ? lane : rows), b = row_of(c, valid && last ? lanes : rows);
    count_row(i, xi, a);
    count_row(i, xi, b);
    const int mine = a.found + b.found;
    using LaneScan = cub::WarpScan<int, lanes>;
    __shared__ typename LaneScan::TempStorage shared;  // empty: the scan uses shuffles
    int place, all;
    LaneScan(shared).ExclusiveSum(mine, place, all);
    int4* overflow = nullptr;
    if (last && all > 4 * capacity.first) overflow = take_overflow(i);
    overflow = cub::ShuffleIndex<lanes>(overflow, lanes - 1, 0xffffffffu);
    const List list{words + i, overflow};
    place = write_row(i, xi, a, place, list);
    write_row(i, xi, b, place, list);
    if (!valid || !last) return;
    for (int at = all; at & 3; ++at) put(list, at, far);
    finish(i, all, capacity.first + (overflow ? capacity.overflow : 0));
  }

 private:
  /// A row around a cell, in the order of for_each_run(), and its hits if they fit into a word.
  struct Row {
    int begin = 0, end = 0, found = 0;
    unsigned bits = 0;
  };
  __device__ __forceinline__ Row row_of(GridCell c, int r) const {
    const int y = D == 2 ? 0 : c.y + r % 3 - 1, z = c.z + (D == 2 ? r : r / 3) - 1;
    if (r >= rows || y < 0 || z < 0 || y >= p.cells_y || z >= p.cells_z) return {};
    const int row = (D == 2 ? z : z * p.cells_y + y) * p.cells_x;
    return {bin_start[(row + max(c.x - 2, 0)) * bins_per_cell(D)],
            bin_start[(row + min(c.x + 2, p.cells_x - 1) + 1) * bins_per_cell(D)]};
  }
  __device__ __forceinline__ void count_row(int i, Vec<Real, D> xi, Row& r) const {
    scan(i, xi, r.begin, r.end, [&](int, unsigned bits) {
      r.found += __popc(bits);
      r.bits = bits;
    });
  }
  /// The memory of a list; overflow is null if it needs none or none is left.
  struct List {
    int4 *words, *overflow;
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
    const int k = at >> 2;
    int4* word = k < capacity.first ? list.words + std::size_t(k) * stride
                 : list.overflow && k < capacity.first + capacity.overflow
                     ? list.overflow + (k - capacity.first)
                     : nullptr;
    if (word) reinterpret_cast<int*>(word)[at & 3] = j;
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
