// Making the neighbour lists: exact, without a branch per candidate. The hits of up to 32
// candidates are collected as bits, then taken out in order.
#pragma once

#include "lib/cuda/transposed_lists.cuh"

namespace pbf::inline PBF_VARIANT {

/// The sign bit of x as the lowest bit of `mask`, the others one place up.
__device__ __forceinline__ unsigned push_sign(float x, unsigned mask) {
  return __funnelshift_l(__float_as_uint(x), mask, 1);
}
__device__ __forceinline__ unsigned push_sign(double x, unsigned mask) {
  return __funnelshift_l(unsigned(__double2hiint(x)), mask, 1);
}

template <class Real>
struct ListPass {
  Params<Real> p;
  const Vec4<Real>* position;
  const int* bin_start;
  int4* words;
  int *count, *longest;
  int stride, capacity;

  /// hits(first, bits): bit 31 - k set where candidate first + k is a neighbour of i.
  template <class F>
  __device__ __forceinline__ void scan(int i, Vec3<Real> xi, int begin, int end, F&& hits) const {
    for (int first = begin; first < end; first += 32) {
      const int n = min(32, end - first);
      unsigned bits = 0;
#pragma unroll 4
      for (int k = 0; k < n; ++k) {
        const Vec3<Real> d = xi - xyz(load(position, first + k));
        bits = push_sign(dot(d, d) - Real(1), bits);
      }
      bits <<= 32 - n;  // the first candidate on top
      if (unsigned(i - first) < unsigned(n)) bits &= ~(0x80000000u >> (i - first));
      hits(first, bits);
    }
  }

  /// One thread makes the list of particle i, packing four entries in registers for each write.
  __device__ void operator()(int i) const {
    const Vec3<Real> xi = xyz(position[i]);
    int4* out = words + i;
    int4 word{0, 0, 0, 0};
    int found = 0;
    const auto put = [&](int j) {
      word = {word.y, word.z, word.w, j};
      ++found;
      if ((found & 3) == 0 && found <= capacity) {
        *out = word;
        out += stride;
      }
    };
    for_each_run(xi, bin_start, p, [&](int begin, int end) {
      scan(i, xi, begin, end, [&](int first, unsigned bits) {
        while (bits) {
          const int k = __clz(int(bits));
          bits &= ~(0x80000000u >> k);
          put(first + k);
        }
      });
    });
    const int all = found;
    if (all < capacity)
      while (found & 3) put(p.n);  // the far particle
    finish(i, all);
  }

  /// Eight threads make it: a row of candidates each (the last one two), counted first, then
  /// written in order. For few particles.
  __device__ void by_lanes(int thread) const {
    const int i = thread / 8, lane = thread % 8;
    const bool valid = i < p.n;
    const Vec3<Real> xi = xyz(position[valid ? i : 0]);
    const Cell c = cell_of(xi, p);
    Row a = row_of(c, valid ? lane : 9), b = row_of(c, valid && lane == 7 ? 8 : 9);
    count_row(i, xi, a);
    count_row(i, xi, b);
    const int mine = a.found + b.found;
    int place = mine;  // inclusive prefix over the eight, then exclusive
#pragma unroll
    for (int d = 1; d < 8; d *= 2) {
      const int below = __shfl_up_sync(0xffffffffu, place, d, 8);
      if (lane >= d) place += below;
    }
    const int all = __shfl_sync(0xffffffffu, place, 7, 8);
    place -= mine;
    place = write_row(i, xi, a, place);
    write_row(i, xi, b, place);
    if (!valid || lane != 7) return;
    for (int at = all; at & 3; ++at) put(i, at, p.n);
    finish(i, all);
  }

 private:
  /// One of the nine rows around a cell (for_each_run's order), and its hits where they fit a word.
  struct Row {
    int begin = 0, end = 0, found = 0;
    unsigned bits = 0;
  };
  __device__ __forceinline__ Row row_of(Cell c, int r) const {
    const int y = c.y + r % 3 - 1, z = c.z + r / 3 - 1;
    if (r >= 9 || y < 0 || z < 0 || y >= p.cells_y || z >= p.cells_z) return {};
    const int row = (z * p.cells_y + y) * p.cells_x;
    return {bin_start[(row + max(c.x - 2, 0)) * kBinsPerCell],
            bin_start[(row + min(c.x + 2, p.cells_x - 1) + 1) * kBinsPerCell]};
  }
  __device__ __forceinline__ void count_row(int i, Vec3<Real> xi, Row& r) const {
    scan(i, xi, r.begin, r.end, [&](int, unsigned bits) {
      r.found += __popc(bits);
      r.bits = bits;
    });
  }
  __device__ __forceinline__ int write_bits(int i, int first, unsigned bits, int place) const {
    while (bits) {
      const int k = __clz(int(bits));
      bits &= ~(0x80000000u >> k);
      put(i, place++, first + k);
    }
    return place;
  }
  __device__ __forceinline__ int write_row(int i, Vec3<Real> xi, const Row& r, int place) const {
    if (r.end - r.begin <= 32) return write_bits(i, r.begin, r.bits, place);
    scan(i, xi, r.begin, r.end,
         [&](int first, unsigned bits) { place = write_bits(i, first, bits, place); });
    return place;
  }
  __device__ __forceinline__ void put(int i, int at, int j) const {
    if (at < capacity)
      reinterpret_cast<int*>(
          words)[4 * (std::size_t(at >> 2) * stride + std::size_t(i)) + std::size_t(at & 3)] = j;
  }
  __device__ __forceinline__ void finish(int i, int all) const {
    count[i] = all < capacity ? all : capacity;
    if (all > capacity) atomicMax(longest, all);
  }
};

}  // namespace pbf::inline PBF_VARIANT
