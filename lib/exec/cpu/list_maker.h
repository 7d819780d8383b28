// Makes the neighbor lists of one chunk of particles, with the working memory of one thread.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "kernels/neighbors.h"
#include "kernels/row_state.h"
#include "lib/exec/cpu/close_pairs.h"

namespace pbf::PBF_VARIANT {

/// Grows by a quarter more than asked for; never shrinks. resize() alone may double the memory.
template <class T>
void make_room(std::vector<T>& v, std::size_t n) {
  if (v.size() >= n) return;
  v.reserve(n + n / 4);
  v.resize(n + n / 4);
}

/// The particles around a half cell, copied to adjacent memory: the candidates of its particles.
template <class Real, int D>
class NearbyParticles {
 public:
  const Candidates<Real, D>& of(Simd simd, Vec3<Real> x, const Vec4<Real>* position,
                                const int* bin_start, const Params<Real>& p, int rows) {
    const GridCell cell = cell_of<D>(x, p);
    if (cell.x == cell_.x && cell.y == cell_.y && cell.z == cell_.z) return candidates_;
    cell_ = cell;
    constexpr std::size_t block = Candidates<Real, D>::block;
    std::size_t n = 0;
    for_each_run<D>(x, bin_start, p, [&](int b, int e) { n += std::size_t(e - b); });
    const std::size_t padded = (n + block - 1) / block * block;
    for (auto* v : {&x_, &z_}) make_room(*v, padded + block);  // copies may overrun
    if constexpr (D == 3) make_room(y_, padded + block);
    make_room(index_, padded + block);
    std::size_t k = 0;
    for_each_run<D>(x, bin_start, p, [&](int b, int e) {
      const CandidateCopy<Real, D> to{&x_[k], y_.data() + (D == 3 ? k : 0), &z_[k], &index_[k]};
      copy_run(simd, position, b, e, rows, to);
      k += std::size_t(e - b);
    });
    for (; k < padded; ++k) {
      x_[k] = z_[k] = std::numeric_limits<Real>::quiet_NaN();
      if constexpr (D == 3) y_[k] = x_[k];
      index_[k] = 0;
    }
    candidates_ = {x_.data(), y_.data(), z_.data(), index_.data(), int(padded)};
    return candidates_;
  }

 private:
  GridCell cell_{-1, -1, -1};
  std::vector<Real> x_, y_, z_;
  std::vector<int> index_;
  Candidates<Real, D> candidates_{};  ///< of `cell_`
};

/// The working memory of one thread.
struct ListScratch {
  /// Initial sizes; `entries`: of one list (cpu_scratch_entries).
  void reserve(int entries) {
    single.resize(std::max(single.size(), 32 * std::size_t(entries)));
    found.resize(std::max(found.size(), 1024 * std::size_t(entries)));
  }
  std::vector<int> single;  ///< lists of one group, one after the other
  std::vector<int> found;   ///< interleaved lists of a chunk
  std::size_t bytes() const { return (single.capacity() + found.capacity()) * sizeof(int); }
};

/// Writes the lists of particles first..last-1 of one chunk to `scratch.found` and returns the
/// number of entries, with padding. groups: those of the chunk's particles. id: null, or images
/// have empty lists. D: dimensions.
template <int D, class Real>
std::size_t make_lists(Simd simd, const Vec4<Real>* position, const int* bin_start,
                       const Params<Real>& p, const int* id, int first, int last, int far,
                       ChunkedLists::Group* groups, ListScratch& scratch) {
  const int bits = lane_bits(simd, sizeof(Real)), width = 1 << bits;
  NearbyParticles<Real, D> nearby;
  std::size_t used = 0;
  for (int i = first; i < last; i += width) {
    std::size_t begin[17], longest = 0, at = 0;
    for (int l = 0; l < width; ++l) {
      begin[l] = begin[l + 1] = at;
      if (i + l >= last || (id && is_image(id[i + l]))) continue;
      const Vec3<Real> x = xyz(position[i + l]);
      const Candidates<Real, D>& c = nearby.of(simd, x, position, bin_start, p, far);
      make_room(scratch.single, at + std::size_t(c.count) + c.block);
      int* out = scratch.single.data() + at;
      const std::size_t n = std::size_t(close_to(simd, c, x, i + l, out) - out);
      longest = std::max(longest, n);
      at = begin[l + 1] = at + n;
    }
    groups[(i - first) >> bits] = {std::uint32_t(used), std::uint32_t(longest)};
    make_room(scratch.found, used + longest * std::size_t(width));
    for (int l = 0; l < width; ++l) {
      int* to = scratch.found.data() + used + l;
      const int* from = scratch.single.data() + begin[l];
      const std::size_t n = begin[l + 1] - begin[l];
      for (std::size_t k = 0; k < n; ++k) to[k << bits] = from[k];
      for (std::size_t k = n; k < longest; ++k) to[k << bits] = far;
    }
    used += longest << bits;
  }
  return used;
}

}  // namespace pbf::PBF_VARIANT
