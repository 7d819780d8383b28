// Loops and sums over items, by OpenMP threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/neighbors.h"
#include "kernels/row_state.h"

namespace pbf::PBF_VARIANT {

class CpuThreads {
 protected:
  explicit CpuThreads(int threads) : threads_(threads) {}

  /// Calls f(first, last) for pieces of 0..n-1; an item is as much work as `share` particles.
  /// Dynamic scheduling: particles at the surface have fewer neighbors, and another program may
  /// occupy a core for a while. from: the first item, in the middle of a piece.
  template <int share, class F>
  void in_pieces(int n, const F& f, int from = 0) {
    constexpr int piece = kPiece / share;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_) if (n - from > kChunk / share)
    for (int first = from / piece * piece; first < n; first += piece)
      f(std::max(first, from), std::min(n - first, piece) + first);
  }
  /// Calls f(begin, end) for the rows first ... last - 1, or for each run of rows among them that
  /// are no images.
  template <class F>
  static void each_run(const RowRange& rows, int first, int last, const F& f) {
    for (int end = last; first < last; first = end, end = last) {
      if (rows.id) {
        while (first < last && rows.leaves_out(first)) ++first;
        for (end = first; end < last && !rows.leaves_out(end);) ++end;
        if (first == end) return;
      }
      f(first, end);
    }
  }
  /// See LevelBrickPass.
  template <class Pass>
  static void of_brick(const Pass& pass, int n) {
    const auto brick = pass.brick(n);
    std::int64_t found[Pass::brick_cells];
    for (int k = 0; k < Pass::brick_cells; ++k) {
      const auto c = pass.cell(brick, k);
      found[k] = pass.grid.has(c) ? pass.finish(c, pass.part(c, 0, 1)) : 0;
    }
    for (int which = 0; which < Pass::brick_corners; ++which) {
      auto sum = pass.share(which, 0, found[0]);
      for (int k = 1; k < Pass::brick_cells; ++k)
        if (found[k] != 0) sum += pass.share(which, k, found[k]);
      pass.finish_corner(brick, which, sum);
    }
  }

  template <class Pass>
  void wholes(int n, const Pass& pass) {
    in_pieces<kShare>(n, [&](int first, int last) {
      for (int i = first; i < last; ++i) pass.finish(i, pass.part(i, 0, 1));
    });
  }

  /// The sum of term(i), which does not depend on the order of terms.
  template <class Sum, class Term>
  Sum sum(int n, const Term& term) {
    Sum total;
#pragma omp parallel num_threads(threads_) if (n > kChunk)
    {
      Sum mine;
#pragma omp for schedule(static) nowait
      for (int i = 0; i < n; ++i) mine.add(term(i));
#pragma omp critical(pbf_sum)
      total.add(mine);
    }
    return total;
  }

  /// The number of particles that pass(i) puts into each of `bins` bins; none if it is negative.
  template <class Pass>
  const std::vector<std::int64_t>& count_in_bins(int n, int bins, const Pass& pass) {
    in_bins_.assign(std::size_t(bins), 0);
#pragma omp parallel num_threads(threads_) if (n > kChunk)
    {
      std::vector<std::int64_t> mine(std::size_t(bins), 0);
#pragma omp for schedule(static) nowait
      for (int i = 0; i < n; ++i)
        if (const int b = pass(i); b >= 0) ++mine[std::size_t(b)];
#pragma omp critical(pbf_count_in_bins)
      for (std::size_t b = 0; b < mine.size(); ++b) in_bins_[b] += mine[b];
    }
    return in_bins_;
  }

  /// The sum of pass(i).
  template <class Pass>
  std::uint64_t sum_of(int n, const Pass& pass) {
    std::uint64_t sum = 0;
#pragma omp parallel for schedule(static) reduction(+ : sum) num_threads(threads_) if (n > 4096)
    for (int i = 0; i < n; ++i) sum += pass(i);
    return sum;
  }
  static constexpr int kChunk = 1 << ChunkedLists::chunk_bits;
  static constexpr int kShare = 16;   ///< work of an item that threads may share, in particles
  static constexpr int kPiece = 256;  ///< of a pass: whole groups of lists, a few microseconds
  int threads_;
  std::vector<std::int64_t> in_bins_{};
};

}  // namespace pbf::PBF_VARIANT
