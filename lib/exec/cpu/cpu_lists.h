// Makes the neighbor lists of the CPU executor.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "lib/exec/cpu/cpu_threads.h"
#include "lib/exec/cpu/host_buffer.h"
#include "lib/exec/cpu/list_maker.h"

namespace pbf::PBF_VARIANT {

class CpuLists : protected CpuThreads {
 protected:
  using Lists = ChunkedLists;
  /// See CpuExec.
  CpuLists(int threads, int list_entries, Simd simd)
      : CpuThreads(threads),
        list_entries_(list_entries),
        simd_(simd),
        single_(std::size_t(threads)) {}

  /// Lists of exactly the pairs of n particles closer than h. Memory grows as needed (throws
  /// std::bad_alloc). far: the row that pads lists.
  template <class Real>
  Lists build_lists(int n, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p) {
    return build_lists(RowRange{0, n}, far, position, bin_start, p);
  }
  template <class Real>
  Lists build_lists(const RowRange& rows, int far, const Vec4<Real>* position, const int* bin_start,
                    const Params<Real>& p) {
    const int n = rows.last;
    const Columns<Real> columns = candidates_of(rows, far, position, bin_start, p);
    const int chunks = (n + kChunk - 1) / kChunk;
    const int bits = lane_bits(simd_, sizeof(Real)), groups_per_chunk = kChunk >> bits;
    chunks_.resize(std::size_t(chunks));
    pointers_.resize(std::size_t(chunks));
    groups_.resize(std::size_t(chunks) * std::size_t(groups_per_chunk));
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_) if (chunks > 1)
    for (int c = rows.first / kChunk; c < chunks; ++c) {
      const int first = c * kChunk, last = std::min(n - first, kChunk) + first;
      ChunkedLists::Group* groups = groups_.data() + std::size_t(c) * std::size_t(groups_per_chunk);
      HostBuffer<int>& mine = chunks_[std::size_t(c)];
      // With the memory of the last update: sizes change little.
      const std::size_t capacity = std::size_t((last - first) * list_entries_);
      if (mine.size() < capacity) mine.resize(capacity);
      std::vector<int>& single = single_[std::size_t(omp_get_thread_num())];
      const std::size_t used = p.dimensions == 2
                                   ? make_lists<2>(simd_, position, columns, bin_start, p, rows.id,
                                                   first, last, far, groups, single, mine)
                                   : make_lists<3>(simd_, position, columns, bin_start, p, rows.id,
                                                   first, last, far, groups, single, mine);
      if (mine.size() > 2 * std::max(used, capacity)) mine.resize(used + used / 8, used);
      pointers_[std::size_t(c)] = mine.data();
    }
    return {pointers_.data(), groups_.data(), bits, far};
  }

  Simd simd() const { return simd_; }
  /// Of the lists and of the memory in which they are made.
  std::size_t list_bytes() const {
    std::size_t sum = groups_.bytes() + columns_.bytes() + chunks_.capacity() * sizeof chunks_[0] +
                      pointers_.capacity() * sizeof pointers_[0];
    for (const auto& c : chunks_) sum += c.bytes();
    for (const auto& s : single_) sum += s.capacity() * sizeof s[0];
    return sum;
  }

 private:
  /// The coordinates of all candidates of these rows.
  template <class Real>
  Columns<Real> candidates_of(const RowRange& rows, int far, const Vec4<Real>* position,
                              const int* bin_start, const Params<Real>& p) {
    const bool flat = p.dimensions == 2;
    const std::size_t length =
        (std::size_t(far) + 2 * Columns<Real>::room - 1) & ~std::size_t(Columns<Real>::room - 1);
    columns_.resize(length * sizeof(Real) * (flat ? 2 : 3));
    Real* const all = reinterpret_cast<Real*>(columns_.data());
    const Columns<Real> columns{all, flat ? nullptr : all + 2 * length, all + length};
    if (rows.first >= rows.last) return columns;
    // Rows are in the order of cells, z slowest: all candidates are in the layers from the one
    // below the first row to the one above the last. The runs of these two rows do not enclose all
    // others: they end at the edges of a layer.
    const auto start_of_layer = [&](int z) {
      const int layer = flat ? p.cells_x : p.cells_x * p.cells_y;
      return bin_start[std::clamp(z, 0, p.cells_z) * layer * bins_per_cell(flat ? 2 : 3)];
    };
    const auto layer_of = [&](int i) {
      const Vec3<Real> x = xyz(position[i]);
      return flat ? cell_of<2>(x, p).z : cell_of<3>(x, p).z;
    };
    const int first = start_of_layer(layer_of(rows.first) - 1),
              last = start_of_layer(layer_of(rows.last - 1) + 2);
    in_pieces<1>(
        last, [&](int b, int e) { fill(simd_, position, b, e, columns); }, first);
    return columns;
  }

  int list_entries_;
  Simd simd_;
  std::vector<std::vector<int>> single_;  ///< per thread, see make_lists()
  std::vector<HostBuffer<int>> chunks_;
  std::vector<const int*> pointers_;
  HostBuffer<ChunkedLists::Group> groups_;
  HostBuffer<std::byte> columns_;
};

}  // namespace pbf::PBF_VARIANT
