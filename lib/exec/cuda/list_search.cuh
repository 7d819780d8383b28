// The search for neighbors: exact, without a branch per candidate. The hits among up to 32
// candidates are collected as bits.
#pragma once

#include "kernels/cell_index.h"
#include "kernels/vec3.h"

namespace pbf::PBF_VARIANT {

constexpr unsigned kWarp = 0xffffffffu;  ///< all threads of a warp

/// Shifts `mask` left by one place and puts the sign bit of x into its lowest bit.
__device__ __forceinline__ unsigned push_sign(float x, unsigned mask) {
  return __funnelshift_l(__float_as_uint(x), mask, 1);
}
__device__ __forceinline__ unsigned push_sign(double x, unsigned mask) {
  return __funnelshift_l(unsigned(__double2hiint(x)), mask, 1);
}

/// D: dimensions of the scene. unchanged: no thread of the kernel moves particles.
template <class Real, int D, bool unchanged>
struct ListSearch {
  static constexpr int rows = D == 2 ? 3 : 9;  ///< of cells around a cell
  Params<Real> p;
  const Vec4<Real>* position;
  const int* bin_start;

  /// Bit 31 - k is set where candidate first + k is a neighbor of i, for k < n <= 32. Loads four
  /// candidates at a time, up to three rows behind the last one.
  __device__ __forceinline__ unsigned hits(int i, Vec<Real, D> xi, int first, int n) const {
    unsigned bits = 0;
    const Vec4<Real>* from = position + first;
    const int fours = (n + 3) & ~3;
#pragma unroll 1
    for (int k = 0; k < fours; k += 4, from += 4) {
      const Vec4<Real> a = at(from), b = at(from + 1), c = at(from + 2), d = at(from + 3);
      for (const Vec4<Real>& x : {a, b, c, d}) bits = push_sign(beyond(xi - point<D>(x)), bits);
    }
    return without(i, first, n, (bits >> (fours - n)) << ((32 - n) & 31));
  }
  /// f(first, hits) for up to 32 candidates at a time, where few threads hide the time of loads.
  template <class F>
  __device__ __forceinline__ void scan(int i, Vec<Real, D> xi, int begin, int end, F&& f) const {
    for (int first = begin; first < end; first += 32) {
      const int n = min(32, end - first);
      unsigned bits = 0;
      const Vec4<Real>* from = position + first;
#pragma unroll 4
      for (int k = 0; k < n; ++k) bits = push_sign(beyond(xi - point<D>(at(from + k))), bits);
      f(first, without(i, first, n, bits << (32 - n)));
    }
  }
  /// The bits without that of particle i itself.
  static __device__ __forceinline__ unsigned without(int i, int first, int n, unsigned bits) {
    return unsigned(i - first) < unsigned(n) ? bits & ~(0x80000000u >> (i - first)) : bits;
  }

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
  static __device__ __forceinline__ Vec4<Real> at(const Vec4<Real>* row) {
    if constexpr (unchanged)
      return load(row, 0);
    else
      return *row;
  }
  /// Negative for a neighbor at distance d.
  static __device__ __forceinline__ Real beyond(Vec<Real, D> d) {
#ifdef PBF_PINNED
    return dot(d, d) - Real(1);
#else
    Real b = mul_add(d.x, d.x, Real(-1));
    if constexpr (D == 3) b = mul_add(d.y, d.y, b);
    return mul_add(d.z, d.z, b);
#endif
  }
};

}  // namespace pbf::PBF_VARIANT
