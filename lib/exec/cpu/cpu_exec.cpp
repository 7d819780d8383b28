#include "lib/exec/cpu/cpu_exec.h"

#include <algorithm>
#include <numeric>

#include "lib/base/machine.h"

namespace pbf::PBF_VARIANT {

namespace {

/// Sorts order[first..last-1], whole bins in order, by id within each bin. Insertion sort: the rows
/// are nearly in that order, because they were before they moved.
void sort_within_bins(const int* bin, const int* id, int first, int last, int* order) {
  int bin_before = -1, id_before = 0;  // of the row at k - 1
  for (int k = first; k < last; ++k) {
    const int row = order[k], b = bin[row], mine = id[row];
    if (b != bin_before || mine > id_before) {
      bin_before = b;
      id_before = mine;
      continue;
    }
    int to = k;
    for (; to > first && bin[order[to - 1]] == b && id[order[to - 1]] > mine; --to)
      order[to] = order[to - 1];
    order[to] = row;
  }
}

}  // namespace

void CpuExec::sort(const int* bin, const int* id, int n, const BinRange& bins, int* order,
                   int* start) {
  // Every thread counts and places the particles of its own range of bins, in order. Particles are
  // nearly in the order of the last sort, so the bins at equal distances among them divide the work
  // about equally, and a thread needs to look at few chunks of particles besides its own.
  const int threads = std::clamp(n / 4096, 1, threads_);
  const int chunks = (n + kChunk - 1) / kChunk;
  struct Share {  // of a thread
    BinRange bins;
    int first = 0, rows = 0;  ///< places in `order`
  };
  std::vector<Share> shares(std::size_t(threads), {bins});
  for (std::size_t t = 1; t < shares.size(); ++t) {
    const int there = bin[std::int64_t(n) * std::int64_t(t) / threads];
    shares[t].bins.begin = std::clamp(there, shares[t - 1].bins.begin, bins.end);
    shares[t - 1].bins.end = shares[t].bins.begin;
  }
  const auto for_rows_of_chunk = [&](int c, const auto& f) {
    const int first = c * kChunk, last = std::min(n - first, kChunk) + first;
    for (int i = first; i < last; ++i) f(i);
  };
  std::vector<BinRange> bins_of_chunk(std::size_t(chunks), bins);
  if (threads > 1)
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int c = 0; c < chunks; ++c) {
      int least = bins.end, most = bins.begin - 1;
      for_rows_of_chunk(c, [&](int i) {
        if (bins.has(bin[i])) least = std::min(least, bin[i]), most = std::max(most, bin[i]);
      });
      bins_of_chunk[std::size_t(c)] = {least, most + 1};
    }
  // f(row) for the rows with these bins, in order.
  const auto for_rows_of = [&](const BinRange& mine, const auto& f) {
    for (int c = 0; c < chunks; ++c) {
      const BinRange here = bins_of_chunk[std::size_t(c)];
      if (here.end <= mine.begin || here.begin >= mine.end) continue;
      for_rows_of_chunk(c, [&](int i) {
        if (mine.has(bin[i])) f(i);
      });
    }
  };
#pragma omp parallel for schedule(static, 1) num_threads(threads) if (threads > 1)
  for (Share& share : shares) {
    std::fill(start + share.bins.begin, start + share.bins.end, 0);
    int rows = 0;
    for_rows_of(share.bins, [&](int i) { ++start[bin[i]], ++rows; });
    share.rows = rows;
  }
  int all = 0;
  for (Share& share : shares) share.first = all, all += share.rows;
#pragma omp parallel for schedule(static, 1) num_threads(threads) if (threads > 1)
  for (const Share& share : shares) {
    if (share.bins.begin == share.bins.end) continue;
    int *const begin = start + share.bins.begin, *const end = start + share.bins.end;
    std::exclusive_scan(begin, end, begin, share.first);
    for_rows_of(share.bins, [&](int i) { order[start[bin[i]]++] = i; });
    sort_within_bins(bin, id, share.first, share.first + share.rows, order);
    // Every entry of `start` is now the start of the next bin.
    std::copy_backward(begin, end - 1, end);
    *begin = share.first;
  }
  start[bins.end] = all;
}

void CpuExec::rank(int n, const int* id, int* place) {
  // A radix sort by 11 bits at a time.
  constexpr int bits = 11, digits = 1 << bits;
  std::vector<int> rows(static_cast<std::size_t>(n)), sorted(rows.size());
  std::iota(rows.begin(), rows.end(), 0);
  const int most = n > 0 ? *std::max_element(id, id + n) : 0;
  for (int shift = 0; shift < 31 && most >> shift; shift += bits) {
    const auto digit = [&](int row) { return std::size_t(id[row] >> shift) % digits; };
    std::size_t first[digits] = {};
    for (const int row : rows) ++first[digit(row)];
    std::exclusive_scan(first, first + digits, first, std::size_t(0));
    for (const int row : rows) sorted[first[digit(row)]++] = row;
    rows.swap(sorted);
  }
  for (int k = 0; k < n; ++k) place[rows[std::size_t(k)]] = k;
}

void CpuExec::describe(SolverInfo& info) const {
  info.backend = "cpu";
  info.device = cpu_model();
  info.driver = simd_name(simd());
  info.threads = threads_;
}

std::size_t CpuExec::bytes() const {
  return list_bytes() + in_bins_.capacity() * sizeof in_bins_[0];
}

}  // namespace pbf::PBF_VARIANT
