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
  // Every thread counts and places the particles of its own range of bins, in order; only `start`
  // is needed as memory. Particles are nearly in the order of the last sort, so the bins at equal
  // distances among them divide the work about equally. At most 4 threads, since each looks at
  // every particle; the sort is a small part of an update.
  const int threads = n > 16384 ? std::min(threads_, 4) : 1;
  int low[5] = {bins.begin}, placed[4] = {0};
  for (int t = 1; t < threads; ++t)
    low[t] = std::clamp(bin[std::int64_t(n) * t / threads], low[t - 1], bins.end);
  low[threads] = bins.end;
#pragma omp parallel for schedule(static, 1) num_threads(threads)
  for (int t = 0; t < threads; ++t) {
    std::fill(start + low[t], start + low[t + 1], 0);
    const auto size = unsigned(low[t + 1] - low[t]);
    int count = 0;
    for (int i = 0; i < n; ++i)
      if (unsigned(bin[i] - low[t]) < size) ++start[bin[i]], ++count;
    placed[t] = count;
  }
#pragma omp parallel for schedule(static, 1) num_threads(threads)
  for (int t = 0; t < threads; ++t) {
    const auto size = unsigned(low[t + 1] - low[t]);
    if (size == 0) continue;
    const int first = std::accumulate(placed, placed + t, 0);
    std::exclusive_scan(start + low[t], start + low[t + 1], start + low[t], first);
    for (int i = 0; i < n; ++i)
      if (unsigned(bin[i] - low[t]) < size) order[start[bin[i]]++] = i;
    sort_within_bins(bin, id, first, first + placed[t], order);
    // Every entry of `start` is now the start of the next bin.
    std::copy_backward(start + low[t], start + low[t + 1] - 1, start + low[t + 1]);
    start[low[t]] = first;
  }
  start[bins.end] = std::accumulate(placed, placed + threads, 0);
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
