#include "lib/cpu/cpu_exec.h"

#include <algorithm>

namespace pbf::inline PBF_VARIANT {

void CpuExec::sort(const int* bin, int n, int bins, int* order, int* start) {
  // Every thread counts and places its own contiguous share of the particles, in order: stable.
  // At most 4: each has a histogram of its own, and the sort is a small part of an update.
  const int threads = n > 16384 ? std::min(threads_, 4) : 1;
  histogram_.assign(std::size_t(threads) * std::size_t(bins), 0);
#pragma omp parallel num_threads(threads)
  {
    const int t = omp_get_thread_num(), all = omp_get_num_threads();
    const int first = int(std::int64_t(n) * t / all), last = int(std::int64_t(n) * (t + 1) / all);
    int* mine = histogram_.data() + std::size_t(t) * std::size_t(bins);
    for (int i = first; i < last; ++i) ++mine[bin[i]];
#pragma omp barrier
#pragma omp single
    {
      int sum = 0;
      for (int c = 0; c < bins; ++c) {
        start[c] = sum;
        for (int k = 0; k < all; ++k) {
          int& h = histogram_[std::size_t(k) * std::size_t(bins) + std::size_t(c)];
          const int count = h;
          h = sum;
          sum += count;
        }
      }
      start[bins] = n;
    }
    for (int i = first; i < last; ++i) order[mine[bin[i]]++] = i;
  }
}

std::size_t CpuExec::list_bytes() const {
  std::size_t sum =
      groups_.bytes() + count_.bytes() + histogram_.capacity() * sizeof(int) +
      chunks_.capacity() * sizeof chunks_[0] + pointers_.capacity() * sizeof pointers_[0] +
      partial_.capacity() * sizeof partial_[0] + in_bins_.capacity() * sizeof in_bins_[0];
  for (const auto& c : chunks_) sum += c.bytes();
  for (const auto& s : scratch_) sum += s.bytes();
  return sum;
}

}  // namespace pbf::inline PBF_VARIANT
