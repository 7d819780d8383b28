// Makes the neighbor lists of one chunk of particles, with the working memory of one thread.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/neighbors.h"
#include "kernels/row_state.h"
#include "lib/exec/cpu/close_pairs.h"
#include "lib/exec/cpu/host_buffer.h"
#include "lib/exec/cpu/interleave.h"

namespace pbf::PBF_VARIANT {

/// Grows by a quarter more than asked for; never shrinks. resize() alone may double the memory.
template <class T>
void make_room(std::vector<T>& v, std::size_t n) {
  if (v.size() >= n) return;
  v.reserve(n + n / 4);
  v.resize(n + n / 4);
}

/// The candidates of the particles of a half cell.
template <int D, class Real>
class NearbyBlocks {
 public:
  explicit NearbyBlocks(Simd simd) : simd_(simd) {}
  const Blocks& of(Vec3<Real> x, const int* bin_start, const Params<Real>& p) {
    const GridCell cell = cell_of<D>(x, p);
    if (cell.x == cell_.x && cell.y == cell_.y && cell.z == cell_.z) return blocks_;
    cell_ = cell;
    blocks_.clear();
    most_ = 0;
    for_each_run<D>(cell.x, cell.x, cell.y, cell.z, bin_start, p, [&](int b, int e) {
      if (b < e) add_rows(simd_, b, e, blocks_);
      most_ += std::size_t(e - b);
    });
    return blocks_;
  }
  std::size_t most() const { return most_; }  ///< candidates of a particle

 private:
  Simd simd_;
  GridCell cell_{-1, -1, -1};
  Blocks blocks_;  ///< of `cell_`
  std::size_t most_ = 0;
};

/// Writes the lists of particles first..last-1 of one chunk to `found`, which grows if it is too
/// small, and returns the number of entries, with padding. columns: of all candidates. groups:
/// those of the chunk's particles. id: null, or images have empty lists. single: working memory of
/// the thread, for the lists of a group one after the other. D: dimensions.
template <int D, class Real>
std::size_t make_lists(Simd simd, const Vec4<Real>* position, const Columns<Real>& columns,
                       const int* bin_start, const Params<Real>& p, const int* id, int first,
                       int last, int far, ChunkedLists::Group* groups, std::vector<int>& single,
                       HostBuffer<int>& found) {
  const int bits = lane_bits(simd, sizeof(Real)), width = 1 << bits;
  NearbyBlocks<D, Real> nearby(simd);
  std::size_t used = 0;
  for (int i = first; i < last; i += width) {
    GroupLists lists;
    std::size_t at = 0;
    for (int l = 0; l < width; ++l) {
      lists.begin[l] = at, lists.size[l] = 0;
      if (i + l < last && !(id && is_image(id[i + l]))) {
        const Vec3<Real> x = xyz(position[i + l]);
        const Blocks& blocks = nearby.of(x, bin_start, p);
        make_room(single, at + nearby.most() + 2 * kAtOnce);
        int* out = single.data() + at;
        lists.size[l] = int(close_to<D>(simd, columns, blocks, x, i + l, out) - out);
        lists.longest = std::max(lists.longest, lists.size[l]);
      }
      make_room(single, at + kAtOnce);
      at += std::size_t(lists.size[l]);
      std::fill_n(single.data() + at, kAtOnce, far);
      at += kAtOnce;
    }
    groups[(i - first) >> bits] = {std::uint32_t(used), std::uint32_t(lists.longest)};
    const std::size_t needed = used + (std::size_t(lists.longest) + kAtOnce) * std::size_t(width);
    if (found.size() < needed) found.resize(needed + needed / 8, used);
    interleave(simd, bits, single.data(), lists, far, found.data() + used);
    used += std::size_t(lists.longest) << bits;
  }
  return used;
}

}  // namespace pbf::PBF_VARIANT
